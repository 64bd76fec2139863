// Headers of OpenEXR files that claim what cannot be.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.h"
#include "core/exr_header.h"

namespace brisance {
namespace {

std::string number(std::uint32_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i)
        bytes += static_cast<char>(value >> (8 * i));
    return bytes;
}

std::string ended(const std::string& text) {
    return text + '\0';
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
    return ended(name) + ended(type) + number(static_cast<std::uint32_t>(value.size())) + value;
}

std::string window(std::uint32_t width, std::uint32_t height) {
    return number(0) + number(0) + number(width - 1) + number(height - 1);
}

constexpr char kZip = 3, kDwaa = 8;

// One part with a channel of halves.
std::string part(std::uint32_t width, std::uint32_t height, char compression, const std::string& more = {}) {
    const std::string channel = ended("Y") + number(1) + std::string(4, '\0') + number(1) + number(1);
    return attribute("channels", "chlist", channel + '\0') +
           attribute("compression", "compression", std::string(1, compression)) +
           attribute("dataWindow", "box2i", window(width, height)) + more + '\0';
}

// What is said of a file of that header and `behind` bytes; empty when nothing is wrong.
std::string answer(const std::string& parts, std::size_t behind = 1000, std::uint32_t flags = 2) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("brisance_exr_header_" + std::to_string(getpid()));
    std::ofstream(file, std::ios::binary) << kExrMagic << number(flags) << parts << std::string(behind, 'x');
    std::string said;
    try {
        check_exr_header(file);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::BadData);
        said = error.what();
        EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    }
    std::filesystem::remove(file);
    return said;
}

bool contains(const std::string& text, const std::string& what) {
    return text.find(what) != std::string::npos;
}

TEST(ExrClaims, WhatFitsIsLeftToOpenExr) {
    EXPECT_EQ(answer(part(640, 480, kZip)), "");
    EXPECT_EQ(answer(part(1, 1, kZip), 0), "");
    EXPECT_EQ(answer(part(4096, 4096, kDwaa)), "");
    EXPECT_EQ(answer(part(640, 480, kZip, attribute("tiles", "tiledesc", number(64) + number(64) + '\0'))), "");
    EXPECT_EQ(answer(part(64, 64, kZip, attribute("mine", "unknown", std::string(500, 'x')))), "");
    constexpr std::uint32_t many_parts = 0x1002;
    EXPECT_EQ(answer(part(64, 64, kZip) + part(32, 32, kZip) + '\0', 1000, many_parts), "");
}

TEST(ExrClaims, AttributesEndWithinTheFile) {
    std::string header = attribute("owner", "string", "somebody");
    header.replace(ended("owner").size() + ended("string").size(), 4, number(0x72726f72));
    EXPECT_TRUE(contains(answer(header), "beyond its end"));
    EXPECT_TRUE(contains(answer(attribute("gain", "float", "12345")), "5 bytes instead of 4"));
    EXPECT_TRUE(contains(answer(attribute("gain", "float", "1234") + attribute("gain", "float", "1234")), "twice"));
    EXPECT_TRUE(contains(answer(std::string(300, 'n')), "has no end"));
    EXPECT_TRUE(contains(answer(part(8, 8, kZip).substr(0, 40), 0), "end"));
}

// OpenEXR reads a value by its type, and may find the next attribute elsewhere than the sizes say.
TEST(ExrClaims, ValuesEndWhereTheirAttributeDoes) {
    const std::string channel = ended("Y") + number(1) + std::string(4, '\0') + number(1) + number(1);
    EXPECT_EQ(answer(attribute("mine", "chlist", channel + '\0') + part(8, 8, kZip)), "");
    EXPECT_NE(answer(attribute("mine", "chlist", channel + "Z") + part(8, 8, kZip)), "");
    EXPECT_NE(answer(attribute("mine", "chlist", channel + '\0' + "more") + part(8, 8, kZip)), "");
    EXPECT_EQ(answer(attribute("texts", "stringvector", number(2) + "ab" + number(0)) + part(8, 8, kZip)), "");
    EXPECT_NE(answer(attribute("texts", "stringvector", number(3) + "ab") + part(8, 8, kZip)), "");
    EXPECT_EQ(answer(attribute("small", "preview", number(1) + number(1) + "rgba") + part(8, 8, kZip)), "");
    EXPECT_NE(answer(attribute("small", "preview", number(99) + number(99) + "rgba") + part(8, 8, kZip)), "");
    EXPECT_NE(answer(attribute("small", "preview", number(0xffffffffu) + number(0xffffffffu)) + part(8, 8, kZip)), "");
}

TEST(ExrClaims, PicturesFitIntoTheirFile) {
    EXPECT_TRUE(contains(answer(part(16384, 16384, kZip)), "cannot be in"));
    EXPECT_TRUE(contains(answer(part(200000, 1, kZip), 100000), "makes no sense"));
    EXPECT_TRUE(contains(answer(part(0, 8, kZip)), "makes no sense"));
    EXPECT_TRUE(contains(answer(part(0xffffffffu, 8, kZip)), "makes no sense"));
    constexpr std::uint32_t many_parts = 0x1002;
    EXPECT_TRUE(contains(answer(part(64, 64, kZip) + part(16384, 16384, kZip) + '\0', 1000, many_parts), "cannot be"));
}

TEST(ExrClaims, TilesFitIntoTheirPicture) {
    const auto tiles = [](std::uint32_t width, std::uint32_t height) {
        return attribute("tiles", "tiledesc", number(width) + number(height) + '\0');
    };
    EXPECT_TRUE(contains(answer(part(640, 480, kZip, tiles(0, 64))), "make no sense"));
    EXPECT_TRUE(contains(answer(part(640, 480, kZip, tiles(64, 0x7fffffff))), "make no sense"));
    EXPECT_TRUE(contains(answer(part(640, 480, kZip, tiles(1, 1))), "640 x 480 tiles cannot be in"));
}

}  // namespace
}  // namespace brisance
