// Files load wherever their buffers are: beside the file, inside it, under any name.
#include <gtest/gtest.h>

#include "gltf_fixture.h"

namespace brisance::testing {
namespace {

TEST(SceneFiles, BuffersBesideTheFile) {
    const TempFolder folder;
    one_triangle().write_gltf(folder / "scene.gltf");
    EXPECT_EQ(load_file(folder / "scene.gltf").scene.triangle_count(), 1u);
    one_triangle().write_gltf(folder / "scene.gltf", (folder / "buffer.bin").string());
    EXPECT_EQ(load_file(folder / "scene.gltf").scene.triangle_count(), 1u) << "an absolute path";
}

TEST(SceneFiles, BuffersAsDataUris) {
    const TempFolder folder;
    const TestGltf gltf = one_triangle();
    gltf.write_gltf(folder / "scene.gltf", "data:application/octet-stream;base64," + base64(gltf.buffer));
    EXPECT_EQ(load_file(folder / "scene.gltf").scene.triangle_count(), 1u);
    gltf.write_gltf(folder / "scene.gltf", "data:text/html,<p>");
    const Failure failure = failure_of_loading(folder / "scene.gltf");
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "data: URI")) << failure.message;
}

TEST(SceneFiles, BuffersWithAnyName) {
    const std::pair<std::string, std::string> names[] = {{"größe 煙.bin", "größe%20煙.bin"},
                                                         {"größe 煙.bin", "gr%C3%B6%c3%9Fe 煙.bin"},
                                                         {"a+b.bin", "a+b.bin"},
                                                         {"50%.bin", "50%25.bin"},
                                                         {"sub/a b.bin", "sub/a%20b.bin"}};
    for (const auto& [name, uri] : names) {
        const TempFolder folder;
        std::filesystem::create_directories((folder / name).parent_path());
        one_triangle().write_gltf(folder / "größe 煙.gltf", uri);
        std::filesystem::rename(folder / "buffer.bin", folder / name);
        EXPECT_EQ(load_file(folder / "größe 煙.gltf").scene.triangle_count(), 1u) << uri;
    }
}

TEST(SceneFiles, ABufferMayBeginWithTheOrderMarkOfJsonsText) {
    const TempFolder folder;
    one_triangle().write_gltf(folder / "scene.gltf");
    std::ifstream in(folder / "scene.gltf");
    const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    write_bytes(folder / "scene.gltf", "\xef\xbb\xbf" + text);
    EXPECT_EQ(load_file(folder / "scene.gltf").scene.triangle_count(), 1u);
}

}  // namespace
}  // namespace brisance::testing
