// Carries grids from the child that reads a file to its parent. Descriptions go through shared memory as a whole, and
// voxels through two halves of a small buffer in turns: while one is filled, the other is read. A buffer that is used
// again and again stays in the processor's cache and costs no new pages.
#pragma once

#include "volume/child/child_process.h"
#include "volume/child/read_vdb.h"
#include "volume/child/shared_memory.h"

namespace brisance {

constexpr std::uint64_t kTurnBytes = std::uint64_t{1} << 20;  // each half

// Memory of both sides: the turns of voxels, then the answer.
class Desk {
public:
    explicit Desk(std::uint64_t bytes) : memory_(bytes + 2 * kTurnBytes) {}
    std::span<std::byte> halves() const { return memory_.bytes().first(2 * kTurnBytes); }
    std::span<std::byte> answer() const { return memory_.bytes().subspan(2 * kTurnBytes); }

private:
    SharedMemory memory_;
};

void put_info(SharedWriter& out, const GridInfo& info);
GridInfo get_info(SharedReader& in);

// The child's side: all but the values of leaves, then these.
void put_grid(SharedWriter& out, const LoadedGrid& grid);
void send_values(const AnyLoadedVoxels& voxels, std::span<std::byte> halves, const Line& line);

struct ReceivedGrid {
    std::optional<AnyRawGrid> voxels;
    GridCensus census;  // where there are no voxels
};

// The parent's side. `receive_turn` returns once the next half is filled, and `return_turn` hands it back; visiting the
// leaves of the grid calls `begin` first. Throws std::out_of_range for what no sound child writes.
struct Turns {
    std::function<void()> begin, receive_turn, return_turn;
    std::span<std::byte> halves;
};
ReceivedGrid get_grid(SharedReader& in, const Turns& turns);

}  // namespace brisance
