// Points as PLY: the data agree with the header, bit by bit.

#include <gtest/gtest.h>

#include <cstring>

#include "core/error.h"
#include "film/write_ply.h"
#include "fixtures.h"

namespace brisance {
namespace {

using testing::contents;
using testing::TemporaryFolder;
using Type = PlyProperty::Type;

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

TEST(Ply, HeaderAndNumbers) {
    const TemporaryFolder folder;
    write_ply(folder / "a.ply",
              {{"x", Type::Double, {1e7 + 0.001, -2.0}},
               {"radius", Type::Float, {0.5, 3e-5}},
               {"profile", Type::Int, {-1.0, 70000.0}},
               {"red", Type::Byte, {254.6, -3.0}}},
              {"made by hand"});
    const std::string header =
        "ply\nformat binary_little_endian 1.0\ncomment made by hand\nelement vertex 2\nproperty double x\n"
        "property float radius\nproperty int profile\nproperty uchar red\nend_header\n";
    const std::string bytes = contents(folder / "a.ply");
    ASSERT_EQ(bytes.substr(0, header.size()), header);
    ASSERT_EQ(bytes.size(), header.size() + 2 * 17);
    const std::size_t first = header.size(), second = first + 17;
    EXPECT_EQ(number_at<double>(bytes, first), 1e7 + 0.001);
    EXPECT_EQ(number_at<float>(bytes, first + 8), 0.5f);
    EXPECT_EQ(number_at<std::int32_t>(bytes, first + 12), -1);
    EXPECT_EQ(number_at<std::uint8_t>(bytes, first + 16), 255);
    EXPECT_EQ(number_at<double>(bytes, second), -2.0);
    EXPECT_EQ(number_at<float>(bytes, second + 8), 3e-5f);
    EXPECT_EQ(number_at<std::int32_t>(bytes, second + 12), 70000);
    EXPECT_EQ(number_at<std::uint8_t>(bytes, second + 16), 0);
}

TEST(Ply, NoPointsAreAFileToo) {
    const TemporaryFolder folder;
    write_ply(folder / "a.ply", {{"x", Type::Float, {}}}, {});
    EXPECT_NE(contents(folder / "a.ply").find("element vertex 0\n"), std::string::npos);
}

TEST(Ply, PropertiesOfUnequalLengthAreRefused) {
    const TemporaryFolder folder;
    EXPECT_THROW(write_ply(folder / "a.ply", {{"x", Type::Float, {1.0}}, {"y", Type::Float, {}}}, {}), Error);
    EXPECT_TRUE(folder.names().empty());
}

TEST(Ply, WhereItHasNoPlaceNothingIsLeft) {
    const TemporaryFolder folder;
    try {
        write_ply(folder / "absent" / "a.ply", {{"x", Type::Float, {1.0}}}, {});
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::CannotCreate);
    }
    EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace brisance
