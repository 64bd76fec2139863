#include "film/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <climits>
#include <csignal>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>
#include <thread>

#include "core/error.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

// Names of temporary files, where a signal handler can read them: no allocation, no lock.
struct UnfinishedFile {
    std::atomic<bool> claimed{false};
    std::atomic<bool> complete{false};  // the name below is whole
    std::array<char, PATH_MAX> name{};
};
static_assert(std::atomic<bool>::is_always_lock_free);

std::array<UnfinishedFile, 16> unfinished_files;
std::atomic<bool> process_is_ending{false};

UnfinishedFile& claim(const std::string& name) {
    for (;;) {
        for (UnfinishedFile& slot : unfinished_files) {
            if (slot.claimed.exchange(true))
                continue;
            name.copy(slot.name.data(), slot.name.size() - 1);
            slot.name[name.size()] = '\0';
            slot.complete = true;
            return slot;
        }
        std::this_thread::yield();
    }
}

fs::path folder_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

[[noreturn]] void throw_write_error(const fs::path& file, int error) {
    const std::string folder = folder_of(file).string();
    const std::string name = file.string();
    switch (error) {
        case ENOENT:
            if (std::error_code ignored; fs::exists(folder, ignored))
                throw Error(
                    ExitCode::CannotCreate,
                    fmt::format("cannot write {}: no file can be made in {}; choose another folder", name, folder));
            throw Error(ExitCode::CannotCreate, fmt::format("cannot write {}: the folder {} does not exist; make it "
                                                            "first, or give --make-folders",
                                                            name, folder));
        case ENOTDIR:
            throw Error(ExitCode::CannotCreate, fmt::format("cannot write {}: {} is not a folder", name, folder));
        case EACCES:
        case EPERM:
        case EROFS:
            throw Error(
                ExitCode::CannotCreate,
                fmt::format("cannot write {}: no permission to write into {}; choose another folder", name, folder));
        case ENAMETOOLONG:
            throw Error(ExitCode::CannotCreate, fmt::format("cannot write {}: the name is too long", name));
        case ENOSPC:
        case EDQUOT:
        case EFBIG:
            throw Error(ExitCode::OutputFailed,
                        fmt::format("cannot write {}: {}; free space there or choose another folder", name,
                                    error == EFBIG ? "the file would be larger than allowed" : "no space left"));
        default:
            throw Error(ExitCode::OutputFailed,
                        fmt::format("cannot write {}: {}", name, std::generic_category().message(error)));
    }
}

// A rename onto a device or pipe would replace it, and onto a link would replace the link: neither is meant.
fs::path final_name(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (!fs::exists(status)) {
        if (fs::is_symlink(fs::symlink_status(file, error)))
            throw Error(ExitCode::CannotCreate,
                        fmt::format("cannot write {}: it is a link to {}, which does not exist; remove the link",
                                    file.string(), fs::read_symlink(file, error).string()));
        return file;
    }
    if (fs::is_directory(status))
        throw Error(ExitCode::CannotCreate, fmt::format("cannot write {}: it is a folder", file.string()));
    if (!fs::is_regular_file(status))
        throw Error(ExitCode::CannotCreate, fmt::format("cannot write {}: it is not a regular file", file.string()));
    const fs::path target = fs::canonical(file, error);
    return error ? file : target;
}

// A temporary file's name is this, with the number of its process between the two.
struct TemporaryName {
    std::string begin, end;
    bool shortened;  // other files may then have the same
};

TemporaryName temporary_name(const fs::path& file) {
    std::array<char, 65> host{};
    if (gethostname(host.data(), host.size() - 1) != 0)
        host = {'h', 'o', 's', 't'};
    // Long names leave no room for host and process within the system's limit: their end is dropped.
    const std::string stem = file.stem().string(), extension = file.extension().string();
    const std::string short_stem = stem.substr(0, 100), short_extension = extension.substr(0, 32);
    return {fmt::format(".{}.{}.", short_stem, host.data()), ".tmp" + short_extension,
            short_stem != stem || short_extension != extension};
}

std::string temporary_file(const fs::path& file) {
    const TemporaryName parts = temporary_name(file);
    const fs::path name = fmt::format("{}{}{}", parts.begin, getpid(), parts.end);
    return (file.has_parent_path() ? file.parent_path() / name : name).string();
}

// The process in a temporary file's name; absent where the name is of another form.
std::optional<pid_t> process_in(const std::string& name, const TemporaryName& parts) {
    if (name.size() <= parts.begin.size() + parts.end.size() || !name.starts_with(parts.begin) ||
        !name.ends_with(parts.end))
        return std::nullopt;
    const char* const first = name.data() + parts.begin.size();
    const char* const last = name.data() + name.size() - parts.end.size();
    pid_t process = 0;
    const auto [stop, error] = std::from_chars(first, last, process);
    return error == std::errc() && stop == last && process > 0 ? std::optional(process) : std::nullopt;
}

bool has_ended(pid_t process) {
    return kill(process, 0) != 0 && errno == ESRCH;
}

class TemporaryFile {
public:
    explicit TemporaryFile(const fs::path& file) : file_(final_name(file)), name_(temporary_file(file_)) {
        if (name_.size() >= PATH_MAX)
            throw_write_error(file_, ENAMETOOLONG);
        slot_ = &claim(name_);
        descriptor_ = open(name_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (descriptor_ < 0) {
            const int error = errno;
            release();
            throw_write_error(file_, error);
        }
        // A signal handler that looked just before the file was made could not delete it.
        while (process_is_ending) {
            unlink(name_.c_str());
            pause();
        }
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    ~TemporaryFile() {
        if (descriptor_ >= 0)
            close(descriptor_);
        if (!renamed_)
            unlink(name_.c_str());
        release();
    }

    void write(std::string_view bytes) {
        while (!bytes.empty()) {
            const ssize_t written = ::write(descriptor_, bytes.data(), std::min<std::size_t>(bytes.size(), 1u << 30));
            if (written < 0 && errno == EINTR)
                continue;
            if (written <= 0)
                throw_write_error(file_, written < 0 ? errno : ENOSPC);
            bytes.remove_prefix(static_cast<std::size_t>(written));
        }
    }

    void publish() {
        // Some file systems report a full disk only here.
        if (fsync(descriptor_) != 0 && errno != EINVAL)
            throw_write_error(file_, errno);
        const int closed = close(descriptor_);
        descriptor_ = -1;
        if (closed != 0)
            throw_write_error(file_, errno);
        if (rename(name_.c_str(), file_.c_str()) != 0)
            throw_write_error(file_, errno);
        renamed_ = true;
        sync_folder();
    }

private:
    void release() {
        slot_->complete = false;
        slot_->claimed = false;
    }

    // Makes the rename survive a power cut. The file is whole either way, so a refusal is no failure.
    void sync_folder() const {
        const int folder = open(folder_of(file_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (folder < 0)
            return;
        static_cast<void>(fsync(folder));
        close(folder);
    }

    fs::path file_;
    std::string name_;
    UnfinishedFile* slot_ = nullptr;
    int descriptor_ = -1;
    bool renamed_ = false;
};

}  // namespace

void write_whole_file(const std::filesystem::path& file, std::string_view bytes) {
    TemporaryFile temporary(file);
    temporary.write(bytes);
    temporary.publish();
}

void check_writable(const std::filesystem::path& file) {
    TemporaryFile probe(file);
}

// What cannot be looked up or deleted stays: it harms nobody.
void remove_leftovers(const std::filesystem::path& file) noexcept try {
    const fs::path whole = final_name(file);
    const TemporaryName parts = temporary_name(whole);
    if (parts.shortened)
        return;
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_of(whole), ignored)) {
        const std::optional<pid_t> process = process_in(entry.path().filename().string(), parts);
        if (process && has_ended(*process) && entry.is_regular_file(ignored))
            fs::remove(entry.path(), ignored);
    }
} catch (const std::exception&) {
}

void remove_unfinished_files() noexcept {
    process_is_ending = true;
    for (const UnfinishedFile& slot : unfinished_files)
        if (slot.complete)
            unlink(slot.name.data());
}

}  // namespace brisance
