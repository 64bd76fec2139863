// Small pictures, and a temporary folder.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "film/image.h"

namespace brisance::testing {

class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "brisance-film-XXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }
    ~TemporaryFolder() {
        std::error_code error;
        std::filesystem::permissions(path_, std::filesystem::perms::owner_all, error);
        std::filesystem::remove_all(path_, error);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

    // Names of everything inside, hidden files too.
    std::vector<std::string> names() const {
        std::vector<std::string> result;
        for (const auto& entry : std::filesystem::directory_iterator(path_))
            result.push_back(entry.path().filename().string());
        return result;
    }

private:
    std::filesystem::path path_;
};

inline std::string contents(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

// A layer whose value at (x, y, channel) is `value(x, y, channel)`.
inline Layer make_layer(const std::string& name, const std::vector<std::string>& channels, int width, int height,
                        const std::function<float(int, int, int)>& value, bool full_float = false) {
    Layer layer{name, channels, full_float, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < static_cast<int>(channels.size()); ++c)
                layer.pixels.push_back(value(x, y, c));
    return layer;
}

inline Image gray_image(int width, int height, float value) {
    return {width, height, {make_layer("", {"R", "G", "B", "A"}, width, height, [&](int, int, int) { return value; })}};
}

}  // namespace brisance::testing
