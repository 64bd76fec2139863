// The plugin: the only door to OpenImageIO. It shares nothing with the program but image_formats.h, and throws nothing.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "image_formats/image_formats.h"

namespace brisance {
namespace {

// glTF's colours are not multiplied by alpha, and PNG's are not either: OpenImageIO would multiply them.
OIIO::ImageSpec as_stored() {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    return config;
}

class Reader final : public ImageReader {
public:
    explicit Reader(std::unique_ptr<OIIO::ImageInput> input,
                    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory = nullptr)
        : memory_(std::move(memory)), input_(std::move(input)) {}

    StoredImage stored() const override {
        const OIIO::ImageSpec& spec = input_->spec();
        return {spec.width, spec.height, spec.depth, spec.nchannels, spec.format == OIIO::TypeDesc::UINT8};
    }
    bool read(int channels, std::span<std::uint8_t> pixels) override {
        return input_->read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT8, pixels.data());
    }
    bool read(int channels, std::span<float> pixels) override {
        return input_->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, pixels.data());
    }
    std::string error() override { return input_->geterror(); }

private:
    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory_;  // outlives the input, which reads from it
    std::unique_ptr<OIIO::ImageInput> input_;
};

class Formats final : public ImageFormats {
public:
    std::unique_ptr<ImageReader> open_file(const std::string& file, const char* format,
                                           std::string& why) const override {
        auto input = created(format, why);
        OIIO::ImageSpec spec;
        if (!input)
            return nullptr;
        if (!input->open(file, spec, as_stored())) {
            why = input->geterror();
            return nullptr;
        }
        return std::make_unique<Reader>(std::move(input));
    }

    std::unique_ptr<ImageReader> open_bytes(std::string_view bytes, const char* format,
                                            std::string& why) const override {
        auto memory = std::make_unique<OIIO::Filesystem::IOMemReader>(const_cast<char*>(bytes.data()), bytes.size());
        auto input = created(format, why);
        if (!input)
            return nullptr;
        input->set_ioproxy(memory.get());
        // The proxy is set twice: JPEG's reader forgets one that its configuration does not name.
        OIIO::ImageSpec spec, config = as_stored();
        void* const proxy = memory.get();
        config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
        if (!input->open("", spec, config)) {
            why = input->geterror();
            return nullptr;
        }
        return std::make_unique<Reader>(std::move(input), std::move(memory));
    }

    std::vector<unsigned char> encode_png(int width, int height, std::span<const std::uint8_t> rgb,
                                          std::string& why) const override {
        std::vector<unsigned char> encoded;
        OIIO::Filesystem::IOVecOutput memory(encoded);
        OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
        spec.attribute("oiio:ColorSpace", "sRGB");
        const auto output = OIIO::ImageOutput::create("png");
        if (!output) {
            why = "OpenImageIO was built without PNG";
            return {};
        }
        if (!output->set_ioproxy(&memory) || !output->open("memory.png", spec) ||
            !output->write_image(OIIO::TypeDesc::UINT8, rgb.data()) || !output->close()) {
            why = output->geterror();
            return {};
        }
        return encoded;
    }

private:
    static std::unique_ptr<OIIO::ImageInput> created(const char* format, std::string& why) {
        auto input = OIIO::ImageInput::create(format);
        if (!input)
            why = std::string("OpenImageIO was built without ") + format;
        return input;
    }
};

}  // namespace

extern "C" __attribute__((visibility("default"))) const ImageFormats* brisance_image_formats() {
    static const Formats formats;
    return &formats;
}

}  // namespace brisance
