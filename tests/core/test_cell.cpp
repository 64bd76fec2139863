// Ledger cells: names and indices agree, and sums are computed per channel.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "core/cell.h"

namespace brisance {
namespace {

// A cell's name is the receiver's letter and the sender's.
TEST(Cells, OfLightAtAPointAreNamedByReceiverAndSender) {
    const std::pair<Sender, std::string> senders[] = {
        {Sender::V, "V"}, {Sender::M, "M"}, {Sender::S, "S"}, {Sender::A, "A"}};
    for (const auto& [sender, letter] : senders) {
        EXPECT_EQ(name_of(cell_of(false, sender)), "M" + letter);
        EXPECT_EQ(name_of(cell_of(true, sender)), "S" + letter);
    }
}

TEST(Cells, EachHasItsOwnName) {
    std::set<std::string> names;
    for (int c = 0; c < kCells; ++c)
        names.insert(name_of(static_cast<Cell>(c)));
    EXPECT_EQ(names.size(), std::size_t(kCells));
    EXPECT_STREQ(name_of(Cell::V), "V");
    EXPECT_STREQ(name_of(Cell::A), "A");
    EXPECT_STREQ(name_of(Cell::SA), "SA");
    EXPECT_EQ(static_cast<int>(Cell::SA), kCells - 1);
}

TEST(CellSums, StartBlack) {
    const CellSum sum;
    for (int c = 0; c < kCells; ++c)
        EXPECT_EQ(sum.at(static_cast<Cell>(c)), Rgb(0.0f));
}

TEST(CellSums, AddEveryCellWithAWeightByChannel) {
    CellSum sum, other;
    for (int c = 0; c < kCells; ++c) {
        sum.at(static_cast<Cell>(c)) = Rgb(1.0f);
        other.at(static_cast<Cell>(c)) = Rgb(float(c), 10.0f * float(c), 100.0f);
    }
    sum.add(other, Rgb(2.0f, 0.5f, 0.0f));
    for (int c = 0; c < kCells; ++c) {
        EXPECT_EQ(sum.at(static_cast<Cell>(c)), Rgb(1.0f + 2.0f * float(c), 1.0f + 5.0f * float(c), 1.0f));
        EXPECT_EQ(other.at(static_cast<Cell>(c)).z, 100.0f);
    }
}

}  // namespace
}  // namespace brisance
