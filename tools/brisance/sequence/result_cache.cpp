#include "result_cache.h"

#include <fmt/format.h>

#include "core/content_hash.h"

namespace brisance {

ResultCache::ResultCache(const CacheOptions& options, FrameStamps& stamps, Progress& progress)
    : folder_(options.folder, std::uint64_t(options.most_mebibytes) << 20, progress),
      stamps_(stamps),
      build_(content_hash_of_file("/proc/self/exe")) {}

std::string ResultCache::key(const std::string& name, const std::string& made_of) const {
    return fmt::format("build {}\n{}\n{}\n", build_, name, made_of);
}

std::optional<std::string> ResultCache::find(const std::string& name, const FrameFile& of) {
    return find(name, stamps_.of(of));
}

void ResultCache::keep(const std::string& name, const FrameFile& of, const std::string& result) {
    keep(name, stamps_.of(of), result);
}

std::optional<std::string> ResultCache::find(const std::string& name, const std::string& made_of) {
    return folder_.find(key(name, made_of));
}

void ResultCache::keep(const std::string& name, const std::string& made_of, const std::string& result) {
    folder_.keep(key(name, made_of), result);
}

std::string ResultCache::summary() const {
    return fmt::format("cache: {} result{} found, {} kept", folder_.found(), folder_.found() == 1 ? "" : "s",
                       folder_.kept());
}

}  // namespace brisance
