#include "core/input_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace brisance {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void throw_missing(const fs::path& file, const std::string& remedy) {
    std::error_code error;
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    std::string why = "no such file";
    if (fs::is_symlink(fs::symlink_status(file, error)))
        why = "is a link to " + fs::read_symlink(file, error).string() + ", which does not exist";
    else if (!fs::exists(folder, error))
        why += "; its folder " + folder.string() + " does not exist either";
    throw Error(ExitCode::MissingInput, file.string() + ": " + why + (remedy.empty() ? "" : "; " + remedy));
}

// What stands where a file should be.
std::string kind_of(const fs::file_status& status) {
    switch (status.type()) {
        case fs::file_type::directory:
            return "is a folder; name a file in it";
        case fs::file_type::fifo:
            return "is a pipe; write it to a file first";
        case fs::file_type::socket:
            return "is a socket; name a file";
        default:
            return "is a device; name a file";
    }
}

// Why the file cannot be opened; empty when it can.
std::string why_unreadable(const fs::path& file) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor >= 0) {
        close(descriptor);
        return {};
    }
    if (errno == EACCES || errno == EPERM)
        return "no permission to read it; allow it with `chmod +r`, or copy the file";
    return std::string("cannot be opened: ") + std::strerror(errno);
}

}  // namespace

std::uint64_t size_of_input(const fs::path& file, ExitCode unusable, const std::string& remedy) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (status.type() == fs::file_type::not_found)
        throw_missing(file, remedy);
    if (!fs::status_known(status))
        throw Error(unusable, file.string() + ": cannot be looked up: " + error.message() +
                                  "; check the permissions of its folder");
    if (!fs::is_regular_file(status))
        throw Error(unusable, file.string() + ": " + kind_of(status));
    const std::string why = why_unreadable(file);
    if (!why.empty())
        throw Error(unusable, file.string() + ": " + why);
    const std::uintmax_t size = fs::file_size(file, error);
    if (error)
        throw Error(unusable, file.string() + ": " + error.message());
    return size;
}

std::string read_input(const fs::path& file, std::uint64_t most, ExitCode unusable) {
    const std::uint64_t size = size_of_input(file, unusable);
    if (size > most)
        throw Error(unusable, file.string() + ": has " + std::to_string(size >> 20) + " MiB, more than the " +
                                  std::to_string(most >> 20) + " MiB that can make sense; name another file");
    std::string bytes(size, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(bytes.data(), static_cast<std::streamsize>(size));
    if (stream.bad() || !stream.is_open())
        throw Error(unusable, file.string() + ": cannot be read; check the disk and copy the file again");
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
    return bytes;
}

}  // namespace brisance
