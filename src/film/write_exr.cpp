#include <ImathMatrix.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfFramesPerSecond.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <optional>
#include <set>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "film/whole_file.h"
#include "film/write_image.h"

namespace brisance {
namespace {

constexpr float kLargestHalf = 65504.0f;

class MemoryStream : public Imf::OStream {
public:
    MemoryStream() : Imf::OStream("memory") {}
    void write(const char bytes[], int count) override {
        const auto size = static_cast<std::size_t>(count);
        if (position_ + size > bytes_.size())
            bytes_.resize(position_ + size);
        std::memcpy(bytes_.data() + position_, bytes, size);
        position_ += size;
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }
    const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
    std::size_t position_ = 0;
};

std::string channel_name(const Layer& layer, const std::string& channel) {
    const bool bare = layer.name.empty() || (layer.channels.size() == 1 && layer.name == channel);
    return bare ? channel : layer.name + "." + channel;
}

// Seconds since 1970 that stand for the time of writing, where the environment fixes them for reproducible files.
std::optional<std::time_t> fixed_time() {
    const char* const text = std::getenv("SOURCE_DATE_EPOCH");
    if (text == nullptr || *text == '\0')
        return std::nullopt;
    long long seconds = 0;
    const char* const end = text + std::strlen(text);
    const auto [rest, error] = std::from_chars(text, end, seconds);
    if (error != std::errc() || rest != end || seconds < 0)
        throw Error(ExitCode::Usage,
                    fmt::format("SOURCE_DATE_EPOCH is \"{}\": expected whole seconds since 1970", text));
    return static_cast<std::time_t>(seconds);
}

void add_date(Imf::Header& header, std::optional<std::time_t> fixed) {
    const std::time_t now = fixed.value_or(std::time(nullptr));
    std::tm parts{};
    if (fixed)
        gmtime_r(&now, &parts);
    else
        localtime_r(&now, &parts);
    Imf::addCapDate(header, fmt::format("{:04}:{:02}:{:02} {:02}:{:02}:{:02}", parts.tm_year + 1900, parts.tm_mon + 1,
                                        parts.tm_mday, parts.tm_hour, parts.tm_min, parts.tm_sec));
    // UTC == local time + utcOffset, the opposite sign of tm_gmtoff.
    Imf::addUtcOffset(header, fixed ? 0.0f : static_cast<float>(-parts.tm_gmtoff));
}

// GLM's columns applied to column vectors are Imath's rows applied to row vectors: the memory is the same.
Imath::M44f imath_matrix(const dmat4& m) {
    Imath::M44f result;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            result[i][j] = static_cast<float>(m[i][j]);
    return result;
}

void add_camera(Imf::Header& header, const Image& image, const ImageMetadata& metadata) {
    dmat4 flip(1.0);
    flip[2][2] = -1.0;  // EXR: left-handed, +z forward
    const dmat4 camera = flip * metadata.camera_from_world;
    Imf::addWorldToCamera(header, imath_matrix(camera));
    if (!(metadata.vertical_fov_degrees > 0.0))
        return;
    // Perspective with w = z; x to the right and y down in [0, 1]. The third coordinate means nothing to readers: it is
    // 1 - 1/z only to keep the matrix invertible.
    const double focal_y = 0.5 / std::tan(0.5 * glm::radians(metadata.vertical_fov_degrees));
    const double focal_x = focal_y * image.height / image.width;
    dmat4 ndc(0.0);
    ndc[0][0] = focal_x;
    ndc[1][1] = -focal_y;
    ndc[2] = glm::dvec4(0.5, 0.5, 1.0, 1.0);
    ndc[3][2] = -1.0;
    Imf::addWorldToNDC(header, imath_matrix(ndc * camera));
}

Imf::Header make_header(const Image& image, const ImageMetadata& metadata) {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    const std::optional<std::time_t> fixed = fixed_time();
    add_date(header, fixed);
    add_camera(header, image, metadata);
    header.insert("imageCounter", Imf::IntAttribute(metadata.frame));
    Imf::addChromaticities(header, Imf::Chromaticities());  // the default is Rec. 709, white D65
    header.insert("colorInteropID", Imf::StringAttribute("lin_rec709_scene"));
    if (metadata.frames_per_second > 0.0)
        Imf::addFramesPerSecond(header, Imf::guessExactFps(metadata.frames_per_second));
    if (!metadata.comments.empty())
        Imf::addComments(header, metadata.comments);
    if (!fixed)
        header.insert("renderTimeSeconds", Imf::FloatAttribute(static_cast<float>(metadata.render_seconds)));
    header.insert("samplesPerPixel", Imf::FloatAttribute(static_cast<float>(metadata.samples_per_pixel)));
    for (const auto& [key, text] : metadata.text)
        header.insert(key, Imf::StringAttribute(text));
    return header;
}

void check_layers(const Image& image) {
    if (image.width < 1 || image.height < 1 || image.layers.empty())
        throw Error(ExitCode::RenderFailed, "the image to be written has no pixels");
    const auto pixel_count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    std::set<std::string> names;
    for (const Layer& layer : image.layers) {
        if (layer.channels.empty() || layer.pixels.size() != pixel_count * layer.channels.size())
            throw Error(ExitCode::RenderFailed, fmt::format("layer \"{}\" does not fill the image", layer.name));
        for (const std::string& channel : layer.channels)
            if (!names.insert(channel_name(layer, channel)).second)
                throw Error(ExitCode::RenderFailed,
                            fmt::format("two channels of the image are called {}", channel_name(layer, channel)));
    }
}

// The layer's pixels as stored, in the layer's own order.
std::vector<half> as_half(const std::vector<float>& pixels, ExrReport& report) {
    std::vector<half> halves(pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        float value = pixels[i];
        if (std::abs(value) > kLargestHalf) {
            ++report.clamped;
            value = std::copysign(kLargestHalf, value);
        }
        halves[i] = half(value);
    }
    return halves;
}

// The brightest colour of the beauty where all of it is too dark for halves; 0 where it is not, or truly black.
float lost_as_half(const Layer& layer) {
    if (!layer.name.empty() || layer.full_float)
        return 0.0f;
    float brightest = 0.0f;
    for (std::size_t i = 0; i < layer.pixels.size(); ++i)
        if (layer.channels[i % layer.channels.size()] != "A")
            brightest = std::max(brightest, std::abs(layer.pixels[i]));
    return half(brightest) == half(0.0f) ? brightest : 0.0f;
}

// A sum that overflowed says nothing: a picture with holes is worse than none.
void refuse_not_finite(const std::filesystem::path& file, const Image& image) {
    for (const Layer& layer : image.layers) {
        const auto odd = [](float value) { return !std::isfinite(value); };
        const auto first = std::find_if(layer.pixels.begin(), layer.pixels.end(), odd);
        if (first == layer.pixels.end())
            continue;
        const std::size_t pixel = static_cast<std::size_t>(first - layer.pixels.begin()) / layer.channels.size();
        const auto width = static_cast<std::size_t>(image.width);
        throw Error(
            ExitCode::RenderFailed,
            fmt::format("{}: not written: {} values of {} are NaN or infinite, the first at pixel {} {}; lower "
                        "fire.strength, the power of lights or the emission of surfaces, or look for damaged "
                        "values in what is read",
                        file.string(), std::count_if(layer.pixels.begin(), layer.pixels.end(), odd),
                        layer.name.empty() ? "the picture" : "layer " + layer.name, pixel % width, pixel / width));
    }
}

template <class T>
void add_slices(Imf::FrameBuffer& frame, const Layer& layer, const std::vector<T>& pixels, int width) {
    const std::size_t pixel_bytes = sizeof(T) * layer.channels.size();
    for (std::size_t c = 0; c < layer.channels.size(); ++c) {
        // OpenEXR takes a pointer to bytes it may write; an output file only reads them.
        char* const base = reinterpret_cast<char*>(const_cast<T*>(pixels.data() + c));
        frame.insert(channel_name(layer, layer.channels[c]),
                     Imf::Slice(layer.full_float ? Imf::FLOAT : Imf::HALF, base, pixel_bytes,
                                pixel_bytes * static_cast<std::size_t>(width)));
    }
}

void encode_exr(MemoryStream& stream, const Image& image, const ImageMetadata& metadata, ExrReport& report) {
    Imf::Header header = make_header(image, metadata);
    Imf::FrameBuffer frame;
    std::vector<std::vector<half>> halves(image.layers.size());
    for (std::size_t i = 0; i < image.layers.size(); ++i) {
        const Layer& layer = image.layers[i];
        for (const std::string& channel : layer.channels)
            header.channels().insert(channel_name(layer, channel),
                                     Imf::Channel(layer.full_float ? Imf::FLOAT : Imf::HALF));
        if (layer.full_float) {
            add_slices(frame, layer, layer.pixels, image.width);
        } else {
            halves[i] = as_half(layer.pixels, report);
            report.all_lost = std::max(report.all_lost, lost_as_half(layer));
            add_slices(frame, layer, halves[i], image.width);
        }
    }
    Imf::setGlobalThreadCount(thread_count());  // blocks are compressed in parallel and written in order
    Imf::OutputFile output(stream, header);
    output.setFrameBuffer(frame);
    output.writePixels(image.height);
}

}  // namespace

std::string ExrReport::describe() const {
    if (all_lost > 0.0f)
        return fmt::format(
            "the picture is stored as black: its brightest value, {:.2g}, is below the smallest half, "
            "6e-08; raise fire.strength or the power of lights, or thin the smoke",
            all_lost);
    return clamped == 0
               ? std::string()
               : fmt::format("{} values above the largest half, {}, were stored as that", clamped, kLargestHalf);
}

ExrReport write_exr(const std::filesystem::path& file, const Image& image, const ImageMetadata& metadata) {
    check_layers(image);
    refuse_not_finite(file, image);
    ExrReport report;
    MemoryStream stream;
    try {
        encode_exr(stream, image, metadata, report);
    } catch (const Iex::BaseExc& error) {
        throw Error(ExitCode::RenderFailed, fmt::format("cannot encode {}: {}", file.string(), error.what()));
    }
    write_whole_file(file, stream.bytes());
    return report;
}

}  // namespace brisance
