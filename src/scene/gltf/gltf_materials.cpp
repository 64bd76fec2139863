#include "scene/gltf/gltf_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "scene/gltf/gltf_accessor.h"
#include "scene/read_texture.h"

namespace brisance {
namespace {

using tinygltf::Value;

constexpr double kMost = 1e20;  // of what has no upper limit

const Value* extension(const tinygltf::Material& material, const char* name) {
    const auto found = material.extensions.find(name);
    return found != material.extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

double number(const Value& object, const char* key, double fallback) {
    return object.Has(key) && object.Get(key).IsNumber() ? object.Get(key).GetNumberAsDouble() : fallback;
}

// -2 where the number is none that an index can be: no list has such an element.
int index(const Value& object, const char* key, int fallback) {
    const double value = number(object, key, fallback);
    return value >= 0.0 && value < 0x1p31 ? static_cast<int>(value) : value == fallback ? fallback : -2;
}

// object[key][i] of an array of numbers.
double number(const Value& object, const char* key, int i, double fallback) {
    if (!object.Has(key) || !object.Get(key).IsArray() || !object.Get(key).Get(i).IsNumber())
        return fallback;
    return object.Get(key).Get(i).GetNumberAsDouble();
}

// Of KHR_texture_transform: scaled, then turned counter-clockwise as seen with v down, then moved.
glm::mat3x2 transform(const Value& t) {
    const double angle = number(t, "rotation", 0.0), c = std::cos(angle), s = std::sin(angle);
    const double su = number(t, "scale", 0, 1.0), sv = number(t, "scale", 1, 1.0);
    return {static_cast<float>(c * su),
            static_cast<float>(-s * su),
            static_cast<float>(s * sv),
            static_cast<float>(c * sv),
            static_cast<float>(number(t, "offset", 0, 0.0)),
            static_cast<float>(number(t, "offset", 1, 0.0))};
}

Wrap wrap_of(int gl) {
    return gl == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::Clamp
           : gl == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::Mirror
                                                         : Wrap::Repeat;
}

}  // namespace

int GltfMaterials::scene_material(int material) {
    if (const auto known = materials_.find(material); known != materials_.end())
        return known->second;
    static const tinygltf::Material plain;
    const tinygltf::Material& source =
        material < 0 ? plain : checked(file_, file_.model.materials, material, "material");
    label_ = material < 0 ? "the default material" : label("material", material, source.name);
    uv_set_ = -1;
    SceneMaterial result = convert(source);
    const int index = static_cast<int>(scene_.materials.size());
    scene_.materials.push_back(std::move(result));
    materials_[material] = index;
    uv_sets_[index] = uv_set_;
    return index;
}

SceneMaterial GltfMaterials::convert(const tinygltf::Material& material) {
    SceneMaterial result;
    result.name = material.name;
    result.double_sided = material.doubleSided;
    read_base(material, result);
    read_extensions(material, result);
    read_emission(material, result);
    read_alpha(material, result);
    const tinygltf::NormalTextureInfo& normal = material.normalTexture;
    result.normal = use(reference(normal.index, normal.texCoord, normal.extensions), false);
    result.normal_scale = clamped(normal.scale, -kMost, kMost, "normalTexture.scale");
    if (material.occlusionTexture.index >= 0)
        progress_.notice(file_.path.string() + ": occlusion textures are left out, light finds its own shadows");
    if (extension(material, "KHR_materials_unlit") != nullptr) {
        result.surface.metallic = result.surface.specular = result.surface.transmission = 0.0f;
        result.surface.thin = false;
        result.surface.roughness = 1.0f;
        result.metal_rough = {};
        progress_.notice(
            fmt::format("{}: {} is unlit, it becomes a matt surface of its colour", file_.path.string(), label_));
    }
    return result;
}

void GltfMaterials::read_base(const tinygltf::Material& material, SceneMaterial& result) {
    const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
    for (std::size_t c = 0; c < 3; ++c)
        result.surface.base_colour[static_cast<int>(c)] = clamped(pbr.baseColorFactor[c], 0.0, 1.0, "baseColorFactor");
    result.alpha = clamped(pbr.baseColorFactor[3], 0.0, 1.0, "baseColorFactor");
    result.surface.metallic = clamped(pbr.metallicFactor, 0.0, 1.0, "metallicFactor");
    result.surface.roughness = clamped(pbr.roughnessFactor, 0.0, 1.0, "roughnessFactor");
    const tinygltf::TextureInfo &colour = pbr.baseColorTexture, &metal_rough = pbr.metallicRoughnessTexture;
    result.base_colour = use(reference(colour.index, colour.texCoord, colour.extensions), true);
    result.metal_rough = use(reference(metal_rough.index, metal_rough.texCoord, metal_rough.extensions), false);
}

void GltfMaterials::read_extensions(const tinygltf::Material& material, SceneMaterial& result) {
    SurfaceMaterial& surface = result.surface;
    if (const Value* const ior = extension(material, "KHR_materials_ior")) {
        const double value = number(*ior, "ior", 1.5);
        if (value == 0.0)
            file_.reject(label_ + ": its ior is 0, for which other renderers reflect all light; no index does that",
                         "give it an ior of 1 to 10");
        surface.ior = clamped(value, 1.0, 10.0, "ior");
    }
    if (const Value* const specular = extension(material, "KHR_materials_specular")) {
        surface.specular = clamped(number(*specular, "specularFactor", 1.0), 0.0, 1.0, "specularFactor");
        for (int c = 0; c < 3; ++c)
            surface.specular_colour[c] =
                clamped(number(*specular, "specularColorFactor", c, 1.0), 0.0, kMost, "specularColorFactor");
        result.specular = use(reference(specular->Get("specularTexture")), false);
        result.specular_colour = use(reference(specular->Get("specularColorTexture")), true);
    }
    if (const Value* const transmission = extension(material, "KHR_materials_transmission")) {
        surface.transmission =
            clamped(number(*transmission, "transmissionFactor", 0.0), 0.0, 1.0, "transmissionFactor");
        result.transmission = use(reference(transmission->Get("transmissionTexture")), false);
    }
    const Value* const volume = extension(material, "KHR_materials_volume");
    const bool solid = volume != nullptr && number(*volume, "thicknessFactor", 0.0) > 0.0;
    surface.thin = surface.transmission > 0.0f && !solid;
    if (solid && volume->Has("attenuationDistance"))
        progress_.notice(
            fmt::format("{}: {} absorbs light within its volume, which is left out", file_.path.string(), label_));
}

void GltfMaterials::read_emission(const tinygltf::Material& material, SceneMaterial& result) {
    double strength = 1.0;
    if (const Value* const extended = extension(material, "KHR_materials_emissive_strength"))
        strength = number(*extended, "emissiveStrength", 1.0);
    for (std::size_t c = 0; c < material.emissiveFactor.size() && c < 3; ++c)
        result.emission[static_cast<int>(c)] =
            clamped(material.emissiveFactor[c] * strength, 0.0, kMost, "emissiveFactor times emissiveStrength");
    const tinygltf::TextureInfo& texture = material.emissiveTexture;
    if (result.emits())
        result.emission_colour = use(reference(texture.index, texture.texCoord, texture.extensions), true);
}

void GltfMaterials::read_alpha(const tinygltf::Material& material, SceneMaterial& result) {
    if (material.alphaMode == "MASK")
        result.alpha_mode = AlphaMode::Mask;
    else if (material.alphaMode == "BLEND")
        result.alpha_mode = AlphaMode::Blend;
    else if (material.alphaMode != "OPAQUE")
        progress_.warning("alpha-mode", fmt::format("{}: {} has an alphaMode that glTF does not know, it is taken as "
                                                    "opaque",
                                                    file_.path.string(), label_));
    result.alpha_cutoff = clamped(material.alphaCutoff, 0.0, kMost, "alphaCutoff");
}

GltfMaterials::Reference GltfMaterials::reference(int texture, int uv_set,
                                                  const tinygltf::ExtensionMap& extensions) const {
    Reference result;
    result.texture = texture;
    result.uv_set = uv_set;
    if (const auto found = extensions.find("KHR_texture_transform");
        found != extensions.end() && found->second.IsObject()) {
        result.uv_set = index(found->second, "texCoord", uv_set);
        result.texture_from_uv = transform(found->second);
        for (int i = 0; i < 6; ++i)
            if (!std::isfinite(result.texture_from_uv[i / 2][i % 2]))
                reject("a texture's transform is not finite");
    }
    return result;
}

GltfMaterials::Reference GltfMaterials::reference(const Value& info) const {
    if (!info.IsObject())
        return {};
    tinygltf::ExtensionMap extensions;
    if (info.Get("extensions").IsObject())
        extensions = info.Get("extensions").Get<Value::Object>();
    return reference(index(info, "index", -1), index(info, "texCoord", 0), extensions);
}

TextureUse GltfMaterials::use(const Reference& reference, bool srgb) {
    if (reference.texture == -1)
        return {};
    if (reference.uv_set < 0)
        reject("a texture uses a set of texture coordinates that cannot be");
    if (uv_set_ >= 0 && reference.uv_set != uv_set_) {
        progress_.warning("uv-sets",
                          fmt::format("{}: {} uses texture coordinates {} and {}; textures with the latter are left "
                                      "out, one set a material is supported",
                                      file_.path.string(), label_, uv_set_, reference.uv_set));
        return {};
    }
    uv_set_ = reference.uv_set;
    const tinygltf::Texture& texture =
        checked(file_, file_.model.textures, reference.texture, (label_ + ": texture").c_str());
    return {load(texture, reference.texture, srgb), reference.texture_from_uv};
}

int GltfMaterials::load(const tinygltf::Texture& texture, int index, bool srgb) {
    if (texture.source < 0)
        reject(fmt::format("texture {} has no PNG or JPEG picture", index));
    tinygltf::Sampler sampler;
    if (texture.sampler >= 0)
        sampler = checked(file_, file_.model.samplers, texture.sampler, "sampler");
    const Wrap u = wrap_of(sampler.wrapS), v = wrap_of(sampler.wrapT);
    const bool nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    const std::tuple key(texture.source, static_cast<int>(u), static_cast<int>(v), nearest, srgb);
    if (const auto known = textures_.find(key); known != textures_.end())
        return known->second;
    // Textures follow each other in the same order at all moments of a scene, since its nodes do.
    const std::size_t next = scene_.textures.size();
    const bool shared = same_pictures_ != nullptr && next < same_pictures_->textures.size();
    scene_.textures.push_back(shared ? same_pictures_->textures[next] : read(texture.source, u, v, nearest, srgb));
    return textures_[key] = static_cast<int>(next);
}

std::shared_ptr<const Texture> GltfMaterials::read(int image, Wrap u, Wrap v, bool nearest, bool srgb) {
    Texture result = decode(image, srgb);
    result.wrap_u = u;
    result.wrap_v = v;
    result.nearest = nearest;
    budget_.claim(file_.path.string(), static_cast<double>(result.bytes.size() + sizeof(float) * result.floats.size()));
    return std::make_shared<const Texture>(std::move(result));
}

Texture GltfMaterials::decode(int index, bool srgb) {
    const tinygltf::Image& image = checked(file_, file_.model.images, index, (label_ + ": image").c_str());
    const std::string name = label("image", index, image.name);
    const std::string where = fmt::format("{}: {} of {}", file_.path.string(), name, label_);
    Texture texture;
    if (image.bufferView >= 0) {
        const ByteRange range = bytes_of_view(file_, image.bufferView, name);
        texture = read_texture({range.first, range.size}, where, srgb, budget_.left());
    } else if (!image.image.empty()) {
        texture = read_texture(image.image, where, srgb, budget_.left());
    } else if (image.uri.starts_with("data:")) {
        reject(name + " is a data: URI of a kind that is not known (image/png and image/jpeg in base64 are)");
    } else {
        const std::filesystem::path path = file_.resolved(image.uri);
        std::error_code error;
        if (!std::filesystem::exists(path, error))
            throw Error(ExitCode::MissingInput, fmt::format("{}: there is no {}; put the picture there, or take the "
                                                            "texture out of the material",
                                                            where, path.string()));
        texture = read_texture(path, srgb, budget_.left());
    }
    if (texture.name.empty())
        texture.name = image.name.empty() ? fmt::format("image {}", index) : image.name;
    return texture;
}

float GltfMaterials::clamped(double value, double low, double high, const char* what) {
    const double result = std::isnan(value) ? low : std::clamp(value, low, high);
    if (result != value)
        progress_.warning("material-range", fmt::format("{}: {}: {} is {}, {} is used", file_.path.string(), label_,
                                                        what, value, result));
    return static_cast<float>(result);
}

void GltfMaterials::reject(const std::string& why) const {
    file_.reject(label_ + ": " + why);
}

}  // namespace brisance
