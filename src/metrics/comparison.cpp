#include "metrics/comparison.h"

#include <cmath>
#include <span>

#include "core/error.h"

namespace brisance {
namespace {

bool is_finite(const Rgb& pixel) {
    return std::isfinite(pixel.x) && std::isfinite(pixel.y) && std::isfinite(pixel.z);
}

// The pixels that are finite in all pictures.
struct Usable {
    std::vector<bool> pixel;
    NotFinite not_finite;
};

bool any_not_finite(std::span<const Picture* const> pictures, std::size_t i) {
    for (const Picture* picture : pictures)
        if (!is_finite(picture->pixels[i]))
            return true;
    return false;
}

Usable usable_pixels(std::span<const Picture* const> images, std::span<const Picture* const> references) {
    Usable result{std::vector<bool>(images[0]->pixels.size()), {}};
    for (std::size_t i = 0; i < result.pixel.size(); ++i) {
        const bool image = any_not_finite(images, i), reference = any_not_finite(references, i);
        result.not_finite.image += image ? 1 : 0;
        result.not_finite.reference += reference ? 1 : 0;
        result.pixel[i] = !image && !reference;
    }
    return result;
}

std::vector<Rgb> kept(const std::vector<Rgb>& pixels, const std::vector<bool>& usable) {
    std::vector<Rgb> result;
    result.reserve(pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i)
        if (usable[i])
            result.push_back(pixels[i]);
    return result;
}

std::vector<Rgb> mean_of_halves(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    std::vector<Rgb> mean(a.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        mean[i] = 0.5f * (a[i] + b[i]);
    return mean;
}

std::vector<const Picture*> pictures_of(const Reference& reference) {
    std::vector<const Picture*> pictures = {&reference.first};
    if (reference.second)
        pictures.push_back(&*reference.second);
    return pictures;
}

void check_size(const Picture& a, const Picture& b) {
    if (a.width != b.width || a.height != b.height || a.pixels.size() != b.pixels.size())
        throw Error(ExitCode::BadData, "pictures of different sizes cannot be compared");
}

// The input of FLIP: pixels that are not usable are black.
Picture cleaned(const Picture& picture, const std::vector<bool>& usable) {
    Picture result = picture;
    for (std::size_t i = 0; i < result.pixels.size(); ++i)
        if (!usable[i])
            result.pixels[i] = Rgb(0.0f);
    return result;
}

HdrFlip flip_of_usable(const Picture& image, const Reference& reference, const Usable& usable,
                       double pixels_per_degree) {
    Picture target = reference.first;
    if (reference.second)
        target.pixels = mean_of_halves(target.pixels, reference.second->pixels);
    HdrFlip flip = hdr_flip(cleaned(image, usable.pixel), cleaned(target, usable.pixel), pixels_per_degree);
    for (std::size_t i = 0; i < usable.pixel.size(); ++i)
        if (!usable.pixel[i])
            flip.errors.values[i] = 1.0f;
    flip.mean = mean_of(flip.errors);
    return flip;
}

std::vector<Rgb> change(const Picture& frame, const Picture& next, const std::vector<bool>& usable) {
    std::vector<Rgb> result = kept(next.pixels, usable);
    const std::vector<Rgb> before = kept(frame.pixels, usable);
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] -= before[i];
    return result;
}

void check_frames(const FrameAndReference& frame, const FrameAndReference& next) {
    for (const FrameAndReference* pair : {&frame, &next}) {
        check_size(pair->image, frame.image);
        for (const Picture* half : pictures_of(pair->reference))
            check_size(*half, frame.image);
    }
    if (frame.reference.second.has_value() != next.reference.second.has_value())
        throw Error(ExitCode::BadData, "the reference of one frame has two halves, that of the other has one picture");
}

}  // namespace

Comparison compare(const Picture& image, const Reference& reference, double pixels_per_degree) {
    const std::vector<const Picture*> images = {&image}, references = pictures_of(reference);
    for (const Picture* half : references)
        check_size(*half, image);
    const Usable usable = usable_pixels(images, references);
    const std::vector<Rgb> pixels = kept(image.pixels, usable.pixel);
    std::vector<Rgb> target = kept(reference.first.pixels, usable.pixel);
    Comparison result;
    result.not_finite = usable.not_finite;
    if (reference.second) {
        const std::vector<Rgb> second = kept(reference.second->pixels, usable.pixel);
        result.halves = measure_halves(pixels, target, second);
        target = mean_of_halves(target, second);
    }
    result.differences = measure_differences(pixels, target);
    result.flip = flip_of_usable(image, reference, usable, pixels_per_degree);
    return result;
}

UsableFrames usable_frames(const FrameAndReference& frame, const FrameAndReference& next) {
    check_frames(frame, next);
    const std::vector<const Picture*> image = {&frame.image}, next_image = {&next.image},
                                      both_images = {&frame.image, &next.image};
    const std::vector<const Picture*> reference = pictures_of(frame.reference),
                                      next_reference = pictures_of(next.reference);
    std::vector<const Picture*> both_references = reference;
    both_references.insert(both_references.end(), next_reference.begin(), next_reference.end());
    return {usable_pixels(image, reference).pixel, usable_pixels(next_image, next_reference).pixel,
            usable_pixels(both_images, both_references).not_finite};
}

TemporalError compare_changes(const FrameAndReference& frame, const FrameAndReference& next) {
    check_frames(frame, next);
    const std::vector<const Picture*> images = {&frame.image, &next.image};
    std::vector<const Picture*> references = pictures_of(frame.reference);
    for (const Picture* half : pictures_of(next.reference))
        references.push_back(half);
    const Usable usable = usable_pixels(images, references);
    const std::vector<Rgb> image = change(frame.image, next.image, usable.pixel);
    std::vector<Rgb> target = change(frame.reference.first, next.reference.first, usable.pixel);
    TemporalError result{usable.not_finite, 0.0, std::nullopt};
    if (frame.reference.second) {
        const std::vector<Rgb> second = change(*frame.reference.second, *next.reference.second, usable.pixel);
        result.halves = measure_halves(image, target, second);
        target = mean_of_halves(target, second);
    }
    result.error = measure_differences(image, target).rrmse;
    return result;
}

}  // namespace brisance
