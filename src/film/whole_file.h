// A file that appears whole or not at all: written under a temporary name in the same folder, synced, then renamed.
#pragma once

#include <filesystem>
#include <string_view>

namespace brisance {

// Replaces `file` by one holding `bytes`. Throws Error CannotCreate (folder missing or not writable, or the name
// belongs to something that is no regular file) or OutputFailed (no space left); `file` is then as it was before.
void write_whole_file(const std::filesystem::path& file, std::string_view bytes);

// Throws Error as write_whole_file would before its first byte. Call it before an expensive computation.
void check_writable(const std::filesystem::path& file);

// Deletes the temporary files that writes of `file` left behind when their process was killed: those of this machine's
// processes that have ended, and of no other file.
void remove_leftovers(const std::filesystem::path& file) noexcept;

// Deletes the temporary files of writes under way and keeps others from being made. Async-signal-safe: for a handler
// that ends the process next, and for nothing else.
void remove_unfinished_files() noexcept;

}  // namespace brisance
