// glTF's materials and their textures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gltf_fixture.h"

namespace brisance::testing {
namespace {

using nlohmann::json;

const std::vector<std::uint8_t> kRed = {255, 0, 0, 255};

// One triangle of the given material.
TestGltf with_material(const json& material) {
    TestGltf gltf = one_triangle();
    gltf.json["meshes"][0]["primitives"][0]["material"] = gltf.add("materials", material);
    return gltf;
}

Loaded load_material(const json& material) {
    return load(with_material(material));
}

int add_picture(TestGltf& gltf, const std::string& bytes) {
    const int view = gltf.add_view(bytes);
    return gltf.add("textures", {{"source", gltf.add("images", {{"bufferView", view}})}});
}

void add_uv(TestGltf& gltf, int set = 0) {
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_" + std::to_string(set)] =
        gltf.add_floats("VEC2", {0, 0, 1, 0, 0, static_cast<float>(set + 1)});
}

// One triangle with a red picture, and uv, as base colour.
TestGltf textured(const json& reference = json::object()) {
    TestGltf gltf = with_material({});
    json info = reference;
    info["index"] = add_picture(gltf, encoded(".png", 1, 1, 4, kRed));
    gltf.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = info;
    add_uv(gltf);
    return gltf;
}

TEST(Materials, FactorsOfTheCoreAndOfExtensions) {
    const Loaded loaded =
        load_material({{"name", "All"},
                       {"doubleSided", true},
                       {"emissiveFactor", {0.5, 0.25, 1.0}},
                       {"alphaMode", "MASK"},
                       {"alphaCutoff", 0.3},
                       {"pbrMetallicRoughness",
                        {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.6}}},
                       {"extensions",
                        {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}},
                         {"KHR_materials_ior", {{"ior", 1.33}}},
                         {"KHR_materials_specular", {{"specularFactor", 0.7}, {"specularColorFactor", {1, 2, 0.5}}}},
                         {"KHR_materials_transmission", {{"transmissionFactor", 0.9}}}}}});
    const SceneMaterial& m = loaded.scene.materials.at(0);
    EXPECT_EQ(m.name, "All");
    EXPECT_EQ(m.surface.base_colour, Rgb(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.surface.metallic, 0.5f);
    EXPECT_EQ(m.surface.roughness, 0.6f);
    EXPECT_EQ(m.surface.ior, 1.33f);
    EXPECT_EQ(m.surface.specular, 0.7f);
    EXPECT_EQ(m.surface.specular_colour, Rgb(1.0f, 2.0f, 0.5f));
    EXPECT_EQ(m.surface.transmission, 0.9f);
    EXPECT_EQ(m.emission, Rgb(4.0f, 2.0f, 8.0f));
    EXPECT_EQ(m.alpha_mode, AlphaMode::Mask);
    EXPECT_EQ(m.alpha, 0.4f);
    EXPECT_EQ(m.alpha_cutoff, 0.3f);
    EXPECT_TRUE(m.double_sided);
    EXPECT_TRUE(m.surface.thin);
    EXPECT_TRUE(loaded.messages.warnings.empty());
    EXPECT_TRUE(loaded.messages.notices.empty());
}

TEST(Materials, ThicknessMakesGlassSolid) {
    const auto thin = [](double thickness) {
        return load_material({{"extensions",
                               {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                {"KHR_materials_volume", {{"thicknessFactor", thickness}}}}}})
            .scene.materials.at(0)
            .surface.thin;
    };
    EXPECT_TRUE(thin(0.0));
    EXPECT_FALSE(thin(0.1));
    EXPECT_TRUE(load_material({{"extensions",
                                {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                 {"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationDistance", 0.5}}}}}})
                    .messages.noticed("absorbs"));
}

TEST(Materials, ValuesOutOfRangeAreClampedWithAWarning) {
    const Loaded loaded =
        load_material({{"emissiveFactor", {-1, 1, 1}},
                       {"pbrMetallicRoughness",
                        {{"baseColorFactor", {2, -1, 0.5, 7}}, {"metallicFactor", -3}, {"roughnessFactor", 1.5}}},
                       {"extensions",
                        {{"KHR_materials_ior", {{"ior", 0.5}}},
                         {"KHR_materials_specular", {{"specularFactor", 3}}},
                         {"KHR_materials_transmission", {{"transmissionFactor", -2}}}}}});
    const SceneMaterial& m = loaded.scene.materials.at(0);
    EXPECT_EQ(m.surface.base_colour, Rgb(1.0f, 0.0f, 0.5f));
    EXPECT_EQ(m.alpha, 1.0f);
    EXPECT_EQ(m.surface.metallic, 0.0f);
    EXPECT_EQ(m.surface.roughness, 1.0f);
    EXPECT_EQ(m.surface.ior, 1.0f);
    EXPECT_EQ(m.surface.specular, 1.0f);
    EXPECT_EQ(m.surface.transmission, 0.0f);
    EXPECT_EQ(m.emission, Rgb(0.0f, 1.0f, 1.0f));
    EXPECT_EQ(std::count_if(loaded.messages.warnings.begin(), loaded.messages.warnings.end(),
                            [](const auto& w) { return w.first == "material-range"; }),
              9);
    EXPECT_TRUE(contains(loaded.messages.warnings[0].second, "material 0"));
}

TEST(Materials, AnIorOf0IsRefused) {
    const Failure failure =
        failure_of_loading(with_material({{"name", "Odd"}, {"extensions", {{"KHR_materials_ior", {{"ior", 0}}}}}}));
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "Odd")) << failure.message;
}

TEST(Materials, UnlitIsMatt) {
    const Loaded loaded = load_material({{"extensions", {{"KHR_materials_unlit", json::object()}}}});
    const SurfaceMaterial& surface = loaded.scene.materials.at(0).surface;
    EXPECT_EQ(surface.metallic, 0.0f);
    EXPECT_EQ(surface.roughness, 1.0f);
    EXPECT_EQ(surface.specular, 0.0f);
    EXPECT_TRUE(loaded.messages.noticed("unlit"));
}

TEST(Materials, AlphaModes) {
    EXPECT_EQ(load_material({{"alphaMode", "BLEND"}}).scene.materials.at(0).alpha_mode, AlphaMode::Blend);
    EXPECT_EQ(load_material(json::object()).scene.materials.at(0).alpha_mode, AlphaMode::Opaque);
    const Loaded unknown = load_material({{"alphaMode", "DITHER"}});
    EXPECT_EQ(unknown.scene.materials.at(0).alpha_mode, AlphaMode::Opaque);
    EXPECT_TRUE(unknown.messages.warned("alpha-mode"));
}

TEST(Materials, OnlyThoseInUseAreRead) {
    TestGltf gltf = with_material({{"name", "Used"}});
    gltf.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 99}}}}}});
    EXPECT_EQ(load(gltf).scene.materials.size(), 1u);
}

TEST(MaterialTextures, EmbeddedInABuffer) {
    const Loaded loaded = load(textured());
    ASSERT_EQ(loaded.scene.textures.size(), 1u);
    EXPECT_TRUE(loaded.scene.textures[0]->srgb);
    EXPECT_EQ(loaded.scene.textures[0]->bytes, kRed);
    EXPECT_EQ(loaded.scene.materials.at(0).base_colour.texture, 0);
    EXPECT_EQ(loaded.scene.meshes.at(0).uv, (std::vector<vec2>{{0, 0}, {1, 0}, {0, 1}}));
    EXPECT_GE(loaded.scene.bytes(), 4u);
}

TEST(MaterialTextures, AsDataUri) {
    TestGltf gltf = textured();
    // A PNG of one red pixel.
    gltf.json["images"][0] = {{"uri",
                               "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4"
                               "z8AAAAMBAQDJ/pLvAAAAAElFTkSuQmCC"}};
    EXPECT_EQ(load(gltf).scene.textures.at(0)->bytes, kRed);
    gltf.json["images"][0] = {{"uri", "data:image/webp;base64,AAAA"}};
    EXPECT_EQ(failure_of_loading(gltf).code, ExitCode::BadData);
}

TEST(MaterialTextures, InFilesWithAnyName) {
    for (const std::string name : {"red.png", "a b+c 50%.png", "größe-煙.png"}) {
        const TempFolder folder;
        write_bytes(folder / name, encoded(".png", 1, 1, 4, kRed));
        for (const bool escaped : {false, true}) {
            std::string uri;
            for (const char c : name) {
                uri += escaped || c == '%' ? '%' : c;
                if (uri.back() == '%')
                    uri.append({"0123456789abcdef"[(c >> 4) & 15], "0123456789ABCDEF"[c & 15]});
            }
            TestGltf gltf = textured();
            gltf.json["images"][0] = {{"uri", uri}};
            gltf.write_glb(folder / "scene.glb");
            EXPECT_EQ(load_file(folder / "scene.glb").scene.textures.at(0)->bytes, kRed) << uri;
        }
    }
}

TEST(MaterialTextures, AMissingPictureNamesItselfAndItsMaterial) {
    TestGltf gltf = textured();
    gltf.json["images"][0] = {{"uri", "bricks/none.png"}};
    gltf.json["materials"][0]["name"] = "Wall";
    const Failure failure = failure_of_loading(gltf);
    EXPECT_EQ(failure.code, ExitCode::MissingInput);
    EXPECT_TRUE(contains(failure.message, "bricks/none.png")) << failure.message;
    EXPECT_TRUE(contains(failure.message, "Wall")) << failure.message;
}

TEST(MaterialTextures, ABrokenPictureNamesItselfAndItsMaterial) {
    const std::string jpeg = encoded(".jpg", 32, 32, 3, std::vector<std::uint8_t>(32 * 32 * 3, 9));
    for (const std::string& broken : {jpeg.substr(0, jpeg.size() / 2), std::string("no picture")}) {
        TestGltf gltf = with_material({{"name", "Wall"}});
        gltf.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = add_picture(gltf, broken);
        add_uv(gltf);
        gltf.json["images"][0]["name"] = "bricks";
        const Failure failure = failure_of_loading(gltf);
        EXPECT_EQ(failure.code, ExitCode::BadData);
        EXPECT_TRUE(contains(failure.message, "bricks")) << failure.message;
        EXPECT_TRUE(contains(failure.message, "Wall")) << failure.message;
    }
}

TEST(MaterialTextures, IndicesBeyondTheListsAreRefused) {
    TestGltf no_texture = textured({{"texCoord", 0}});
    no_texture.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 5;
    EXPECT_EQ(failure_of_loading(no_texture).code, ExitCode::BadData);
    for (const char* key : {"source", "sampler"}) {
        TestGltf gltf = textured();
        gltf.json["textures"][0][key] = 5;
        EXPECT_EQ(failure_of_loading(gltf).code, ExitCode::BadData) << key;
    }
    for (const json& wrong : {json(5), json(-1), json(1e300), json(-1e300)}) {
        TestGltf gltf = textured();
        gltf.json["materials"][0]["extensions"]["KHR_materials_specular"]["specularTexture"] = {{"index", 0},
                                                                                                {"texCoord", wrong}};
        if (wrong == 5) {
            EXPECT_TRUE(load(gltf).messages.warned("uv-sets"));
        } else {
            EXPECT_EQ(failure_of_loading(gltf).code, ExitCode::BadData) << wrong;
        }
        gltf.json["materials"][0]["extensions"]["KHR_materials_specular"]["specularTexture"] = {{"index", wrong}};
        if (wrong != -1) {
            EXPECT_EQ(failure_of_loading(gltf).code, ExitCode::BadData) << wrong;
        }
    }
    TestGltf no_source = textured();
    no_source.json["textures"][0].erase("source");
    EXPECT_EQ(failure_of_loading(no_source).code, ExitCode::BadData);
    TestGltf no_view = textured();
    no_view.json["images"][0]["bufferView"] = 77;
    EXPECT_EQ(failure_of_loading(no_view).code, ExitCode::BadData);
    TestGltf long_view = textured();
    long_view.json["bufferViews"][1]["byteLength"] = 1 << 30;
    EXPECT_EQ(failure_of_loading(long_view).code, ExitCode::BadData);
}

TEST(MaterialTextures, SamplersAndColourSpacesMakeTexturesOfTheirOwn) {
    TestGltf gltf = textured();
    const int sampler = gltf.add("samplers", {{"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}});
    const int nearest = gltf.add("textures", {{"source", 0}, {"sampler", sampler}});
    json& material = gltf.json["materials"][0];
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", nearest}};
    material["normalTexture"] = {{"index", 0}, {"scale", 0.5}};
    material["emissiveTexture"] = {{"index", 0}};
    material["emissiveFactor"] = {1, 1, 1};
    material["occlusionTexture"] = {{"index", 0}, {"texCoord", 1}};
    material["extensions"] = {
        {"KHR_materials_specular", {{"specularTexture", {{"index", 0}}}, {"specularColorTexture", {{"index", 0}}}}},
        {"KHR_materials_transmission", {{"transmissionTexture", {{"index", 0}}}}}};
    const Loaded loaded = load(gltf);
    const SceneMaterial& m = loaded.scene.materials.at(0);
    ASSERT_EQ(loaded.scene.textures.size(), 3u) << "sRGB, linear, and linear by another sampler";
    const Texture& rough = *loaded.scene.textures.at(static_cast<std::size_t>(m.metal_rough.texture));
    EXPECT_TRUE(rough.nearest);
    EXPECT_EQ(rough.wrap_u, Wrap::Clamp);
    EXPECT_EQ(rough.wrap_v, Wrap::Mirror);
    EXPECT_FALSE(rough.srgb);
    for (const TextureUse& use : {m.base_colour, m.emission_colour, m.specular_colour})
        EXPECT_TRUE(loaded.scene.textures.at(static_cast<std::size_t>(use.texture))->srgb);
    for (const TextureUse& use : {m.normal, m.specular, m.transmission})
        EXPECT_FALSE(loaded.scene.textures.at(static_cast<std::size_t>(use.texture))->srgb);
    EXPECT_EQ(m.normal_scale, 0.5f);
    EXPECT_TRUE(loaded.messages.noticed("occlusion"));
    EXPECT_TRUE(loaded.messages.warnings.empty());
}

TEST(MaterialTextures, TransformsAreAffine) {
    // The example of KHR_texture_transform: the lower left quadrant, rotated.
    const json transform = {{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}};
    const Loaded loaded = load(textured({{"extensions", {{"KHR_texture_transform", transform}}}}));
    const glm::mat3x2 m = loaded.scene.materials.at(0).base_colour.texture_from_uv;
    const auto expect_moved = [&](vec2 uv, vec2 expected) {
        EXPECT_NEAR(glm::length(m * vec3(uv, 1.0f) - expected), 0.0f, 1e-6);
    };
    expect_moved({0, 0}, {0, 1});
    expect_moved({1, 0}, {0, 0.5});
    expect_moved({0, 1}, {0.5, 1});
}

TEST(MaterialTextures, AnotherSetOfCoordinates) {
    TestGltf gltf = textured({{"texCoord", 1}});
    add_uv(gltf, 1);
    const Loaded loaded = load(gltf);
    EXPECT_EQ(loaded.scene.meshes.at(0).uv.at(2), vec2(0, 2));
    EXPECT_TRUE(loaded.messages.warnings.empty());
    TestGltf moved = textured({{"extensions", {{"KHR_texture_transform", {{"texCoord", 1}}}}}});
    add_uv(moved, 1);
    EXPECT_EQ(load(moved).scene.meshes.at(0).uv.at(2), vec2(0, 2));
}

TEST(MaterialTextures, OneSetOfCoordinatesIsUsedTheOthersTexturesAreLeftOut) {
    TestGltf gltf = textured();
    add_uv(gltf, 1);
    gltf.json["materials"][0]["normalTexture"] = {{"index", 0}, {"texCoord", 1}};
    const Loaded loaded = load(gltf);
    EXPECT_EQ(loaded.scene.materials.at(0).normal.texture, -1);
    EXPECT_EQ(loaded.scene.materials.at(0).base_colour.texture, 0);
    EXPECT_TRUE(loaded.messages.warned("uv-sets"));
}

TEST(MaterialTextures, CoordinatesMayBeMissingOrTooFew) {
    TestGltf gltf = textured();
    gltf.json["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
    const Loaded loaded = load(gltf);
    EXPECT_TRUE(loaded.scene.meshes.at(0).uv.empty());
    EXPECT_TRUE(loaded.messages.warned("no-uv"));
    TestGltf few = textured();
    few.json["accessors"].back()["count"] = 2;
    EXPECT_EQ(failure_of_loading(few).code, ExitCode::BadData);
}

TEST(MaterialTextures, NormalisedIntegersAsCoordinates) {
    TestGltf gltf = textured();
    auto& accessor = gltf.json["accessors"].back();
    accessor["bufferView"] = gltf.add_view(std::string("\0\0\xff\0\0\xff", 6));
    accessor["componentType"] = 5121;
    accessor["normalized"] = true;
    EXPECT_EQ(load(gltf).scene.meshes.at(0).uv, (std::vector<vec2>{{0, 0}, {1, 0}, {0, 1}}));
}

TEST(MaterialTextures, CountAgainstTheMemory) {
    const TempFolder folder;
    TestGltf gltf = with_material({});
    gltf.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] =
        add_picture(gltf, encoded(".png", 512, 512, 3, std::vector<std::uint8_t>(512 * 512 * 3)));
    add_uv(gltf);
    gltf.write_glb(folder / "scene.glb");
    EXPECT_EQ(failure_of([&] { load_file(folder / "scene.glb", 0.0, 512 * 512 * 4); }).code, ExitCode::Temporary);
    EXPECT_EQ(load_file(folder / "scene.glb", 0.0, 512 * 512 * 4 + 20000).scene.textures.size(), 1u);
}

}  // namespace
}  // namespace brisance::testing
