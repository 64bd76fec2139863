#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTestFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/exr_header.h"
#include "core/printable.h"
#include "film/write_image.h"

namespace brisance {
namespace {

constexpr std::int64_t kMostPixels = std::int64_t{1} << 28;  // 16384 x 16384; more is a damaged header

// A few bytes can state a display window of any size. Empty space around the data is filled up to 512 MiB (8K in four
// channels), or where the data has a 64th of the pixels at least.
constexpr std::size_t kMostEmptyValues = std::size_t{1} << 27;
constexpr std::size_t kMostEmptyPerPixel = 64;

[[noreturn]] void reject(const std::filesystem::path& file, const std::string& why) {
    throw Error(ExitCode::BadData, fmt::format("{}: {}", file.string(), why));
}

// R, G, B, A and X, Y, Z in their own order, anything else by name after them.
std::pair<std::size_t, std::string> channel_rank(const std::string& name) {
    static constexpr std::string_view known = "RGBAXYZ";
    const std::size_t index = name.size() == 1 ? known.find(name[0]) : std::string_view::npos;
    return {std::min(index, known.size()), name};
}

std::pair<std::string, std::string> split_channel(const std::string& full) {
    const std::size_t point = full.rfind('.');
    if (point != std::string::npos)
        return {full.substr(0, point), full.substr(point + 1)};
    const bool beauty = full == "R" || full == "G" || full == "B" || full == "A";
    return {beauty ? "" : full, full};
}

std::vector<Layer> layers_of(const std::filesystem::path& file, const Imf::ChannelList& channels) {
    std::map<std::string, Layer> by_name;  // "" sorts first: the beauty
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
            reject(file, fmt::format("channel {} is subsampled, which is not supported",
                                     printable(channel.name(), kLongestName)));
        const auto [layer_name, name] = split_channel(channel.name());
        Layer& layer = by_name[layer_name];
        layer.name = layer_name;
        layer.channels.push_back(name);
        layer.full_float = layer.full_float || channel.channel().type != Imf::HALF;
    }
    std::vector<Layer> layers;
    for (auto& [name, layer] : by_name) {
        std::sort(layer.channels.begin(), layer.channels.end(),
                  [](const std::string& a, const std::string& b) { return channel_rank(a) < channel_rank(b); });
        layers.push_back(std::move(layer));
    }
    if (layers.empty())
        reject(file, "it has no channels");
    return layers;
}

std::string stored_name(const Imf::ChannelList& channels, const Layer& layer, const std::string& channel) {
    const std::string full = layer.name + "." + channel;
    return !layer.name.empty() && channels.findChannel(full) != nullptr ? full : channel;
}

// Moves the pixels of `data` to where they are within `display`.
std::vector<float> placed(const std::vector<float>& pixels, std::size_t channels, const Imath::Box2i& data,
                          const Imath::Box2i& display) {
    if (data == display)
        return pixels;
    const std::int64_t data_width = std::int64_t{data.max.x} - data.min.x + 1;
    const std::int64_t width = std::int64_t{display.max.x} - display.min.x + 1;
    const std::int64_t height = std::int64_t{display.max.y} - display.min.y + 1;
    std::vector<float> result(static_cast<std::size_t>(width * height) * channels);
    const int left = std::max(data.min.x, display.min.x), right = std::min(data.max.x, display.max.x);
    const int top = std::max(data.min.y, display.min.y), bottom = std::min(data.max.y, display.max.y);
    for (std::int64_t y = top; y <= bottom && left <= right; ++y) {
        const auto from = static_cast<std::size_t>((y - data.min.y) * data_width + left - data.min.x) * channels;
        const auto to = static_cast<std::size_t>((y - display.min.y) * width + left - display.min.x) * channels;
        std::copy_n(pixels.begin() + static_cast<std::ptrdiff_t>(from),
                    static_cast<std::size_t>(right - left + 1) * channels,
                    result.begin() + static_cast<std::ptrdiff_t>(to));
    }
    return result;
}

std::int64_t pixel_count(const std::filesystem::path& file, const Imath::Box2i& box) {
    const std::int64_t width = std::int64_t{box.max.x} - box.min.x + 1;
    const std::int64_t height = std::int64_t{box.max.y} - box.min.y + 1;
    if (width < 1 || height < 1 || width > kMostPixels / height)
        reject(file, fmt::format("its size of {} x {} pixels makes no sense", width, height));
    return width * height;
}

void check_empty_space(const std::filesystem::path& file, std::size_t stored, std::size_t shown,
                       const std::vector<Layer>& layers) {
    std::size_t channels = 0;
    for (const Layer& layer : layers)
        channels += layer.channels.size();
    if (shown * channels > kMostEmptyValues && shown / kMostEmptyPerPixel > stored)
        reject(file, fmt::format("its display window of {} pixels has only {} pixels of data; crop it to these", shown,
                                 stored));
}

Image read_layers(const std::filesystem::path& file) {
    Imf::InputFile input(file.c_str());
    const Imath::Box2i data = input.header().dataWindow();
    const Imath::Box2i display = input.header().displayWindow();
    const auto count = static_cast<std::size_t>(pixel_count(file, data));
    const auto shown = static_cast<std::size_t>(pixel_count(file, display));
    const Imf::ChannelList& channels = input.header().channels();
    Image image{display.max.x - display.min.x + 1, display.max.y - display.min.y + 1, layers_of(file, channels)};
    check_empty_space(file, count, shown, image.layers);

    Imf::FrameBuffer frame;
    const std::int64_t data_width = std::int64_t{data.max.x} - data.min.x + 1;
    for (Layer& layer : image.layers) {
        const std::size_t n = layer.channels.size();
        layer.pixels.assign(count * n, 0.0f);
        const std::size_t pixel_bytes = sizeof(float) * n;
        for (std::size_t c = 0; c < n; ++c)
            frame.insert(stored_name(channels, layer, layer.channels[c]),
                         Imf::Slice::Make(Imf::FLOAT, layer.pixels.data() + c, data, pixel_bytes,
                                          pixel_bytes * static_cast<std::size_t>(data_width)));
    }
    input.setFrameBuffer(frame);
    input.readPixels(data.min.y, data.max.y);
    for (Layer& layer : image.layers)
        layer.pixels = placed(layer.pixels, layer.channels.size(), data, display);
    return image;
}

// Imath's rows applied to row vectors are GLM's columns applied to column vectors.
dmat4 matrix_of(const Imath::M44f& m) {
    dmat4 result;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            result[i][j] = double(m[i][j]);
    return result;
}

ExrMetadata read_header(const std::filesystem::path& file) {
    const Imf::InputFile input(file.c_str());
    ExrMetadata metadata;
    for (auto at = input.header().begin(); at != input.header().end(); ++at)
        if (const auto* const text = dynamic_cast<const Imf::StringAttribute*>(&at.attribute()))
            metadata.text[at.name()] = text->value();
    if (const auto* const frame = input.header().findTypedAttribute<Imf::IntAttribute>("imageCounter"))
        metadata.frame = frame->value();
    if (const auto* const seconds = input.header().findTypedAttribute<Imf::FloatAttribute>("renderTimeSeconds"))
        metadata.render_seconds = seconds->value();
    if (Imf::hasWorldToNDC(input.header()))
        metadata.ndc_from_world = matrix_of(Imf::worldToNDC(input.header()));
    return metadata;
}

// Calls `read` for a file that is there and of a kind that can be read; what OpenEXR throws becomes an Error.
template <class Read>
auto read_checked(const std::filesystem::path& file, const Read& read) {
    check_exr_header(file);
    bool tiled = false, deep = false, several_parts = false;
    if (!Imf::isOpenExrFile(file.c_str(), tiled, deep, several_parts))
        reject(file, "it is not an OpenEXR file");
    if (deep || several_parts)
        reject(file,
               fmt::format("{} files are not supported; convert it to one flat part", deep ? "deep" : "multi-part"));
    try {
        return read(file);
    } catch (const Iex::BaseExc& damage) {
        reject(file, fmt::format("truncated or damaged: {}", printable(damage.what())));
    }
}

}  // namespace

Image read_exr(const std::filesystem::path& file) {
    return read_checked(file, read_layers);
}

ExrMetadata read_exr_metadata(const std::filesystem::path& file) {
    return read_checked(file, read_header);
}

}  // namespace brisance
