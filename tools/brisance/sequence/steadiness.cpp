#include "steadiness.h"

#include <fmt/format.h>

#include <algorithm>

#include "film/write_image.h"
#include "metrics/layers.h"
#include "metrics/passing_change.h"

namespace brisance {

void Steadiness::add(int frame, const std::filesystem::path& exr) {
    const Image image = read_exr(exr);
    last_.push_back({frame, picture_of(image, {""}).picture, motion_source(exr, image, read_exr_metadata(exr), "")});
    if (last_.size() > 3)
        last_.pop_front();
    if (last_.size() < 3 || last_[1].frame - last_[0].frame != last_[2].frame - last_[1].frame)
        return;
    const Seen &before = last_[0], &middle = last_[1], &after = last_[2];
    const std::optional<Motion> back = motion_between(before.source, middle.source);
    const std::optional<Motion> forth = motion_between(after.source, middle.source);
    if (!back || !forth)
        return;
    frames_.push_back(
        {middle.frame, passing_change(middle.picture, {before.picture, *back}, {after.picture, *forth}).change});
}

std::string Steadiness::summary() const {
    if (frames_.empty())
        return "";
    std::vector<double> changes;
    for (const OfFrame& f : frames_)
        changes.push_back(f.change);
    std::ranges::nth_element(changes, changes.begin() + std::ptrdiff_t(changes.size() / 2));
    const OfFrame& most = *std::ranges::max_element(frames_, {}, &OfFrame::change);
    return fmt::format("change against both neighbours: median {:.2g} %, largest {:.2g} % at frame {}",
                       100.0 * changes[changes.size() / 2], 100.0 * most.change, most.frame);
}

}  // namespace brisance
