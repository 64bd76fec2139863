#include "image_formats/image_formats.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "core/error.h"

namespace brisance {
namespace {

// Never unloaded: the library keeps threads and tables until the process ends.
const ImageFormats* load_plugin() {
    void* const plugin = dlopen(BRISANCE_IMAGE_PLUGIN, RTLD_NOW | RTLD_LOCAL);
    using Entry = const ImageFormats* (*)();
    const auto entry = plugin ? reinterpret_cast<Entry>(dlsym(plugin, "brisance_image_formats")) : nullptr;
    if (entry == nullptr)
        throw Error(
            ExitCode::RenderFailed,
            fmt::format("cannot load the library for pictures ({}); build or install Brisance again", dlerror()));
    return entry();
}

}  // namespace

const ImageFormats& image_formats() {
    static const ImageFormats* const formats = load_plugin();
    return *formats;
}

}  // namespace brisance
