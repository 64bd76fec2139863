#include "target.h"

#include <unistd.h>

#include <fstream>

namespace brisance::fuzz {

std::filesystem::path file_with(std::string_view bytes, const std::string& extension) {
    static const std::filesystem::path folder = std::filesystem::exists("/dev/shm")
                                                    ? std::filesystem::path("/dev/shm")
                                                    : std::filesystem::temp_directory_path();
    std::filesystem::path file = folder / ("brisance_fuzz_" + std::to_string(getpid()) + extension);
    std::ofstream(file, std::ios::binary | std::ios::trunc)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    static const struct Remover {
        std::filesystem::path file;
        ~Remover() {
            std::error_code ignored;
            std::filesystem::remove(file, ignored);
        }
    } remover{file};
    return file;
}

}  // namespace brisance::fuzz
