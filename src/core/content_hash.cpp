#include "core/content_hash.h"

#include <fmt/format.h>

#include <fstream>
#include <memory>
#include <vector>

#include "core/input_file.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace brisance {

namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;

}  // namespace

std::string content_hash(std::string_view bytes) {
    return fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()));
}

std::string content_hash_of_file(const std::filesystem::path& file) {
    size_of_input(file);
    std::ifstream in(file, std::ios::binary);
    const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
    XXH3_64bits_reset(state.get());
    std::vector<char> piece(kPiece);
    while (in) {
        in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
        XXH3_64bits_update(state.get(), piece.data(), static_cast<std::size_t>(in.gcount()));
    }
    if (!in.eof())
        throw Error(ExitCode::BadData,
                    fmt::format("{}: it cannot be read; check the disk and copy it again", file.string()));
    return fmt::format("{:016x}", XXH3_64bits_digest(state.get()));
}

}  // namespace brisance
