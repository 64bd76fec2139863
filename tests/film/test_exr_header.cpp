// Metadata in the header of an EXR.

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <glm/gtc/matrix_transform.hpp>

#include "core/error.h"
#include "film/write_image.h"
#include "fixtures.h"

namespace brisance {
namespace {

using testing::contents;
using testing::gray_image;
using testing::TemporaryFolder;

// Sets a variable for one test.
class Environment {
public:
    Environment(const char* name, const char* value) : name_(name) { setenv(name, value, 1); }
    ~Environment() { unsetenv(name_); }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

private:
    const char* name_;
};

Imf::Header header_of(const std::filesystem::path& file) {
    return Imf::InputFile(file.c_str()).header();
}

Imath::V3f projected(const Imath::V3f& point, const Imath::M44f& matrix) {
    Imath::V3f result;
    matrix.multVecMatrix(point, result);
    return result;
}

TEST(ExrHeader, CameraMatricesProjectAsThePictureDoes) {
    const TemporaryFolder folder;
    // At (10, -20, 5), looking along world +y with z up.
    const dvec3 eye(10.0, -20.0, 5.0);
    ImageMetadata metadata;
    metadata.camera_from_world = glm::lookAt(eye, eye + dvec3(0, 1, 0), dvec3(0, 0, 1));
    metadata.vertical_fov_degrees = 90.0;
    write_exr(folder / "a.exr", gray_image(200, 100, 1.0f), metadata);
    const Imf::Header header = header_of(folder / "a.exr");

    // EXR's camera space is left-handed: x right, y up, z forward.
    const Imath::V3f ahead(10.0f, -16.0f, 5.0f);  // 4 m before the camera
    EXPECT_LT((projected(ahead, Imf::worldToCamera(header)) - Imath::V3f(0, 0, 4)).length(), 1e-5f);
    const Imath::V3f right_and_up(11.0f, -16.0f, 7.0f);
    EXPECT_LT((projected(right_and_up, Imf::worldToCamera(header)) - Imath::V3f(1, 2, 4)).length(), 1e-5f);

    // NDC: (0, 0) is the upper left corner. With 90 degrees, 4 m away the picture is 8 m high and 16 m wide.
    const Imath::V3f centre = projected(ahead, Imf::worldToNDC(header));
    EXPECT_NEAR(centre.x, 0.5f, 1e-5f);
    EXPECT_NEAR(centre.y, 0.5f, 1e-5f);
    const Imath::V3f upper_left = projected(Imath::V3f(10.0f - 8.0f, -16.0f, 5.0f + 4.0f), Imf::worldToNDC(header));
    EXPECT_NEAR(upper_left.x, 0.0f, 1e-5f);
    EXPECT_NEAR(upper_left.y, 0.0f, 1e-5f);
    EXPECT_NE(Imf::worldToNDC(header).determinant(), 0.0f);

    // And as it is read back: column vectors, the depth in w.
    const std::optional<dmat4> ndc_from_world = read_exr_metadata(folder / "a.exr").ndc_from_world;
    ASSERT_TRUE(ndc_from_world);
    const glm::dvec4 seen = *ndc_from_world * glm::dvec4(11.0, -16.0, 7.0, 1.0);
    EXPECT_NEAR(seen.w, 4.0, 1e-5);
    EXPECT_NEAR(seen.x / seen.w, 0.5 + 1.0 / 16.0, 1e-5);
    EXPECT_NEAR(seen.y / seen.w, 0.5 - 2.0 / 8.0, 1e-5);
}

TEST(ExrHeader, StandardAttributesAreThere) {
    const TemporaryFolder folder;
    ImageMetadata metadata;
    metadata.frame = 1042;
    metadata.render_seconds = 12.5;
    metadata.samples_per_pixel = 4.0;
    metadata.frames_per_second = 23.976;
    metadata.comments = "a remark";
    metadata.text["brisance/version"] = "1.2.3";
    write_exr(folder / "a.exr", gray_image(4, 4, 1.0f), metadata);
    const Imf::Header header = header_of(folder / "a.exr");

    EXPECT_EQ(header.compression(), Imf::ZIP_COMPRESSION);
    EXPECT_EQ(header.typedAttribute<Imf::IntAttribute>("imageCounter").value(), 1042);
    EXPECT_EQ(header.typedAttribute<Imf::FloatAttribute>("renderTimeSeconds").value(), 12.5f);
    EXPECT_EQ(header.typedAttribute<Imf::FloatAttribute>("samplesPerPixel").value(), 4.0f);
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("colorInteropID").value(), "lin_rec709_scene");
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("brisance/version").value(), "1.2.3");
    EXPECT_EQ(Imf::comments(header), "a remark");
    EXPECT_EQ(Imf::framesPerSecond(header).n, 24000);
    EXPECT_EQ(Imf::framesPerSecond(header).d, 1001u);
    EXPECT_EQ(Imf::chromaticities(header).red, Imath::V2f(0.64f, 0.33f));
    EXPECT_TRUE(Imf::hasUtcOffset(header));
    const std::string date = Imf::capDate(header);
    ASSERT_EQ(date.size(), 19u);
    EXPECT_EQ(date[4], ':');
    EXPECT_EQ(date[10], ' ');
}

TEST(ExrHeader, UnknownRateAndNoRemarkAreLeftOut) {
    const TemporaryFolder folder;
    write_exr(folder / "a.exr", gray_image(4, 4, 1.0f), {});
    const Imf::Header header = header_of(folder / "a.exr");
    EXPECT_FALSE(Imf::hasFramesPerSecond(header));
    EXPECT_FALSE(Imf::hasComments(header));
    EXPECT_FALSE(Imf::hasWorldToNDC(header));  // no field of view given
}

TEST(ExrHeader, IsReadBackWithoutThePixels) {
    const TemporaryFolder folder;
    ImageMetadata metadata;
    metadata.frame = -7;
    metadata.render_seconds = 12.5;
    metadata.comments = "a remark";
    metadata.text = {{"brisance/shot", "{\n  \"name\": \"n\u00e4me\"\n}"}, {"brisance/version", "1.2.3"}};
    write_exr(folder / "a.exr", gray_image(4, 4, 1.0f), metadata);
    const ExrMetadata read = read_exr_metadata(folder / "a.exr");
    EXPECT_EQ(read.frame, -7);
    EXPECT_EQ(read.render_seconds, 12.5);
    EXPECT_EQ(read.text.at("brisance/shot"), metadata.text.at("brisance/shot"));
    EXPECT_EQ(read.text.at("brisance/version"), "1.2.3");
    EXPECT_EQ(read.text.at("comments"), "a remark");
    EXPECT_EQ(read.text.count("brisance/volume"), 0u);
}

TEST(ExrHeader, WhatIsNotThereIsNotReadBack) {
    const TemporaryFolder folder;
    Imf::Header header(4, 4);  // as another program writes it
    header.channels().insert("Y", Imf::Channel());
    { const Imf::OutputFile written((folder / "a.exr").c_str(), header); }
    const ExrMetadata read = read_exr_metadata(folder / "a.exr");
    EXPECT_FALSE(read.frame.has_value());
    EXPECT_FALSE(read.render_seconds.has_value());
    EXPECT_TRUE(read.text.empty());
}

TEST(ExrHeader, OfUnusableFilesIsAnError) {
    const TemporaryFolder folder;
    const auto code = [](const std::filesystem::path& file) {
        try {
            read_exr_metadata(file);
        } catch (const Error& error) {
            return error.code();
        }
        return ExitCode::Success;
    };
    EXPECT_EQ(code(folder / "absent.exr"), ExitCode::MissingInput);
    EXPECT_EQ(code(folder.path()), ExitCode::BadData);
    std::ofstream(folder / "text.exr") << "no picture";
    EXPECT_EQ(code(folder / "text.exr"), ExitCode::BadData);
}

TEST(ExrHeader, FixedTimeMakesFilesIdentical) {
    const TemporaryFolder folder;
    const Environment epoch("SOURCE_DATE_EPOCH", "1000000000");
    const Environment zone("TZ", "Asia/Tokyo");
    ImageMetadata metadata;
    metadata.render_seconds = 1.0;
    write_exr(folder / "a.exr", gray_image(50, 40, 0.7f), metadata);
    metadata.render_seconds = 2.0;
    write_exr(folder / "b.exr", gray_image(50, 40, 0.7f), metadata);
    EXPECT_EQ(contents(folder / "a.exr"), contents(folder / "b.exr"));
    const Imf::Header header = header_of(folder / "a.exr");
    EXPECT_EQ(Imf::capDate(header), "2001:09:09 01:46:40");
    EXPECT_EQ(Imf::utcOffset(header), 0.0f);
}

TEST(ExrHeader, UtcIsLocalTimePlusOffset) {
    const TemporaryFolder folder;
    const Environment zone("TZ", "UTC-9");  // POSIX sign: nine hours ahead of UTC
    tzset();
    write_exr(folder / "a.exr", gray_image(4, 4, 1.0f), {});
    EXPECT_EQ(Imf::utcOffset(header_of(folder / "a.exr")), -9.0f * 3600.0f);
}

TEST(ExrHeader, UnreadableFixedTimeIsAnError) {
    const TemporaryFolder folder;
    const Environment epoch("SOURCE_DATE_EPOCH", "yesterday");
    EXPECT_THROW(write_exr(folder / "a.exr", gray_image(4, 4, 1.0f), {}), Error);
    EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace brisance
