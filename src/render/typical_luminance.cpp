#include "render/typical_luminance.h"

#include <algorithm>
#include <vector>

namespace brisance {

namespace {

// One ray each.
constexpr int kPixelsAcross = 64;

Camera with_few_pixels(const Camera& camera, const Medium& medium) {
    CameraSettings few = camera.settings();
    few.width = std::min(few.width, kPixelsAcross);
    few.height = std::max(1, few.height * few.width / camera.settings().width);
    return {few, medium};
}

// What samples leave to all pixels stays with them.
SurfaceLightingInput alone(SurfaceLightingInput lighting, int width) {
    lighting.width = width;
    lighting.samples = 1;
    lighting.tolerance = lighting.tolerance_of_bases = {};
    lighting.lengths = nullptr;
    lighting.shared = lighting.shared_sky = nullptr;
    lighting.reuse = nullptr;
    lighting.compensation = nullptr;
    lighting.bound = nullptr;
    lighting.grains = nullptr;
    return lighting;
}

std::vector<double> luminances(const Layer& layer) {
    const std::size_t channels = layer.channels.size();
    std::vector<double> out;
    for (std::size_t i = 0; i + 2 < layer.pixels.size(); i += channels)
        out.push_back(luminance(Rgb(layer.pixels[i], layer.pixels[i + 1], layer.pixels[i + 2])));
    return out;
}

}  // namespace

// Twice, by the same rays: the noise of both is independent, and adds nothing to the mean of their products.
float typical_luminance(const Camera& camera, PictureSettings settings, SurfaceLightingInput lighting) {
    const Camera few = with_few_pixels(camera, lighting.field.medium());
    settings.samples_per_axis = 1;
    settings.medium_samples_per_axis = settings.finest_medium_samples_per_axis = 0;
    settings.edge_refinement = 1;
    settings.cells = false;
    SurfaceShader shader(alone(lighting, few.settings().width));
    Progress silent;
    const auto picture = [&](int pass) {
        settings.pass = pass;
        return luminances(render_picture(lighting.field, few, settings, silent, [&](const auto& samples, auto& light) {
                              shader.shade(samples, light);
                          }).layer(""));
    };
    const std::vector<double> one = picture(0), other = picture(1);
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        sum += 0.5 * (one[i] + other[i]);
        squares += one[i] * other[i];
    }
    return sum > 0.0 ? static_cast<float>(squares / sum) : 0.0f;
}

}  // namespace brisance
