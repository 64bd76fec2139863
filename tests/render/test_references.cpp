// Pictures of real volumes against another renderer's unbiased ones. Each reference comes as two independent halves A
// and B: sum (m - A)(m - B) / sum A B estimates the squared relative error of m free of the references' own noise.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "film/write_image.h"
#include "render/render_frame.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

dvec3 triple(const nlohmann::json& j) {
    return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()};
}

Shot shot_of(const fs::path& file) {
    const auto json = nlohmann::json::parse(std::ifstream(file));
    const auto& v = json["volume"];
    const auto& c = json["camera"];
    Shot shot;
    shot.volume.grids.density = v["density"].get<std::string>();
    shot.volume.grids.flame = v["emission"].get<std::string>();
    shot.volume.grids.temperature = "";
    shot.medium.smoke.extinction_per_metre = v["sigma_t"];
    shot.medium.smoke.albedo = Rgb(v["albedo"].get<float>());
    shot.medium.smoke.mean_cosine = v["g"];
    shot.medium.fire.strength = v["emission_strength"];
    shot.medium.fire.threshold = v.value("emission_threshold", 0.0f);
    shot.camera_given = true;
    shot.camera.eye = triple(c["eye"]);
    shot.camera.target = triple(c["target"]);
    shot.camera.up = triple(c["up"]);
    shot.camera.vertical_fov_degrees = c["vfov_degrees"];
    shot.camera.width = c["width"];
    shot.camera.height = c["height"];
    return shot;
}

struct Difference {
    double error, mean;  // relative
};

Difference difference(const Image& image, const std::vector<std::string>& cells, const std::string& reference) {
    const std::vector<float> a = read_exr(reference + ".A.exr").layers[0].pixels;
    const std::vector<float> b = read_exr(reference + ".B.exr").layers[0].pixels;
    double square = 0.0, norm = 0.0, sum = 0.0, reference_sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        double m = 0.0;
        for (const std::string& cell : cells)
            m += image.layer(cell).pixels[3 * i];
        square += (m - a[i]) * (m - b[i]);
        norm += double(a[i]) * b[i];
        sum += m;
        reference_sum += 0.5 * (a[i] + b[i]);
    }
    return {std::sqrt(std::max(square, 0.0) / norm), sum / reference_sum - 1.0};
}

class References : public ::testing::TestWithParam<const char*> {};

// Bounds are about a fifth above what was measured with the default (final) settings.
TEST_P(References, AreMetByTheFinalPreset) {
    const char* data = std::getenv("BRISANCE_DATA");
    if (!data)
        GTEST_SKIP() << "BRISANCE_DATA is not set: no reference images";
    const fs::path folder = fs::path(data) / "references";
    const Shot shot = shot_of(folder / (std::string(GetParam()) + ".json"));
    const auto json = nlohmann::json::parse(std::ifstream(folder / (std::string(GetParam()) + ".json")));
    Progress silent;
    const Image image =
        render_frame(shot, fs::path(data) / "volumes" / json["volume"]["file"].get<std::string>(), 0, silent).image;
    const std::string reference = (folder / GetParam()).string();
    const auto expect = [&](const std::vector<std::string>& cells, const std::string& order, double error,
                            double mean) {
        const Difference d = difference(image, cells, reference + "." + order);
        EXPECT_LT(d.error, error) << order;
        EXPECT_LT(std::abs(d.mean), mean) << order;
        RecordProperty(order + "_error_percent", std::to_string(100.0 * d.error));
        RecordProperty(order + "_mean_percent", std::to_string(100.0 * d.mean));
        std::printf("%s %s: error %.3f %%, mean %+.3f %%\n", GetParam(), order.c_str(), 100.0 * d.error,
                    100.0 * d.mean);
    };
    expect({"V"}, "V", 0.010, 0.003);
    expect({"V", "MV"}, "V+MV", 0.009, 0.008);
    expect({"V", "MV", "MM"}, "all", 0.020, 0.006);
}

INSTANTIATE_TEST_SUITE_P(OfAnotherRenderer, References, ::testing::Values("ember", "ember_core", "fireball"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace brisance
