#include <algorithm>
#include <cmath>

#include "camera/camera.h"
#include "stability/case.h"
#include "stability/closed_forms.h"

namespace brisance::stability {

namespace {

std::vector<dvec3> colours_of(const Image& image, const std::string& name) {
    const Layer& layer = image.layer(name);
    const std::size_t stride = layer.channels.size();
    std::vector<dvec3> colours(layer.pixels.size() / stride);
    for (std::size_t i = 0; i < colours.size(); ++i)
        colours[i] = {layer.pixels[i * stride], layer.pixels[i * stride + 1], layer.pixels[i * stride + 2]};
    return colours;
}

dvec3 sum_of(const std::vector<dvec3>& colours) {
    dvec3 sum(0.0);
    for (const dvec3& c : colours)
        sum += c;
    return sum;
}

double norm(const dvec3& v) {
    return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

// Where the truth is 0, the error is absolute [W/(m^2 sr)].
double relative(double error, double wanted) {
    return wanted > 0.0 ? error / wanted : error;
}

// Standard error of the sum of a picture's pixels, from the sums of the pictures that it is the mean of.
double spread_of_sums(const std::vector<Image>& pictures, const std::string& layer) {
    const double n = double(pictures.size());
    dvec3 sum(0.0), square(0.0);
    for (const Image& picture : pictures) {
        const dvec3 one = sum_of(colours_of(picture, layer));
        sum += one / n;
        square += one * one / n;
    }
    return norm(glm::sqrt(glm::max(square - sum * sum, 0.0) / (n - 1.0)));
}

// The same; where pixels are independent, from two halves pixel by pixel.
double noise_of_sum(const RenderedFrame& frame, const std::string& layer, const Method& method) {
    if (method.shares_noise())
        return spread_of_sums(frame.halves, layer);
    if (frame.halves.size() != 2)
        return 0.0;
    const std::vector<dvec3> a = colours_of(frame.halves[0], layer), b = colours_of(frame.halves[1], layer);
    dvec3 square(0.0);
    for (std::size_t i = 0; i < a.size(); ++i)
        square += 0.25 * (a[i] - b[i]) * (a[i] - b[i]);
    return norm(glm::sqrt(square));
}

Measured of_mean(const RenderedFrame& frame, const std::vector<dvec3>& wanted, const std::string& layer,
                 const Method& method) {
    const dvec3 found = sum_of(colours_of(frame.image, layer)), truth = sum_of(wanted);
    return {relative(norm(found - truth), norm(truth)), relative(noise_of_sum(frame, layer, method), norm(truth))};
}

Measured of_pixels(const std::vector<dvec3>& found, const std::vector<dvec3>& wanted) {
    double error = 0.0, square = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        error += glm::dot(found[i] - wanted[i], found[i] - wanted[i]);
        square += glm::dot(wanted[i], wanted[i]);
    }
    return {relative(std::sqrt(error), std::sqrt(square)), 0.0};
}

// Of a picture whose pixels are sampled independently of each other: of its mean, with the noise
// from their spread.
Measured of_sampled_pixels(const std::vector<dvec3>& found, const std::vector<dvec3>& wanted) {
    dvec3 sum(0.0), square(0.0);
    for (std::size_t i = 0; i < found.size(); ++i) {
        sum += found[i] - wanted[i];
        square += (found[i] - wanted[i]) * (found[i] - wanted[i]);
    }
    const double n = double(found.size()), truth = norm(sum_of(wanted));
    const dvec3 spread = glm::sqrt(glm::max(square - sum * sum / n, 0.0));
    return {relative(norm(sum), truth), relative(norm(spread), truth)};
}

Measured against(const Scene& scene, const RenderedFrame& frame, const std::vector<dvec3>& wanted,
                 const std::string& layer, const Method& method) {
    if (!method.is_grid())
        return of_mean(frame, wanted, layer, method);
    const std::vector<dvec3> found = colours_of(frame.image, layer);
    return scene.surroundings ? of_sampled_pixels(found, wanted) : of_pixels(found, wanted);
}

// L2 distance to a reference, free of its noise: the product of the distances to two independent halves.
Measured against_halves(const std::vector<dvec3>& found, const RenderedFrame& reference) {
    const std::vector<dvec3> a = colours_of(reference.halves.at(0), ""), b = colours_of(reference.halves.at(1), "");
    double product = 0.0, square = 0.0, spread = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double one = glm::dot(found[i] - a[i], found[i] - b[i]);
        product += one;
        spread += one * one;
        square += glm::dot(a[i], b[i]);
    }
    const double error = std::sqrt(std::max(product, 0.0));
    const double noise = std::sqrt(spread) / std::max(2.0 * error, std::sqrt(std::sqrt(spread)));
    return {relative(error, std::sqrt(square)), relative(noise, std::sqrt(square))};
}

// The path tracer by other means. Emission at collisions alone is the most different of them, but null collisions do
// not end where a brick holds smoke much denser than the rest of it.
Scene by_other_estimators(const Scene& scene) {
    constexpr float kMostDepth = 20.0f;  // of a voxel
    Scene other = scene;
    TracingSettings& t = other.shot.tracing;
    if (scene.medium.max_extinction * scene.medium.spacing < kMostDepth)
        t.emission = EmissionEstimator::Collision;
    t.free_flight = FreeFlight::NullCollision;
    t.transmittance = TransmittanceEstimator::Ratio;
    t.light_sampling = false;
    return other;
}

}  // namespace

Measure every_pixel_is(const Rgb& radiance, const std::string& layer) {
    return [=](const Scene& scene, const RenderedFrame& frame, const Method& method, const Render&) {
        const std::size_t pixels = std::size_t(frame.image.width) * frame.image.height;
        return against(scene, frame, std::vector<dvec3>(pixels, dvec3(radiance)), layer, method);
    };
}

Measure every_ray_is(const RadianceOfRay& radiance, const std::string& layer) {
    return [=](const Scene& scene, const RenderedFrame& frame, const Method& method, const Render&) {
        const Camera camera(scene.shot.camera, scene.medium);
        std::vector<dvec3> wanted;
        for (int y = 0; y < frame.image.height; ++y)
            for (int x = 0; x < frame.image.width; ++x)
                wanted.emplace_back(radiance(scene.shot.camera.eye, camera.ray(x + 0.5, y + 0.5).direction));
        return against(scene, frame, wanted, layer, method);
    };
}

Measure same_picture_as(const std::function<Scene()>& other) {
    return [=](const Scene& scene, const RenderedFrame& frame, const Method& method, const Render& render) {
        Scene twin = other();
        twin.shot.tracing = scene.shot.tracing;
        const RenderedFrame wanted = render(twin, method);
        Measured m = against(scene, frame, colours_of(wanted.image, ""), "", method);
        m.noise *= std::sqrt(2.0);
        return m;
    };
}

Measure same_paths_as(const std::function<Scene()>& other) {
    return [pictures = same_picture_as(other)](const Scene& scene, const RenderedFrame& frame, const Method& method,
                                               const Render& render) {
        Measured m = pictures(scene, frame, method, render);
        m.noise = 0.0;
        return m;
    };
}

Measure power_is(const std::function<double(const Scene&)>& power) {
    return [=](const Scene& scene, const RenderedFrame& frame, const Method& method, const Render&) {
        const Camera camera(scene.shot.camera, scene.medium);
        const double side = camera.pixel_angle() * glm::length(scene.shot.camera.target - scene.shot.camera.eye);
        const double truth = power(scene), area = side * side;
        const double found = area * norm(sum_of(colours_of(frame.image, ""))) / 3.0;
        return Measured{std::abs(found - truth) / truth, area * noise_of_sum(frame, "", method) / 3.0 / truth};
    };
}

Measure like_the_reference(int samples) {
    return [=](const Scene& scene, const RenderedFrame& frame, const Method& method, const Render& render) {
        const Method path;
        Scene reference = method.is_path() ? by_other_estimators(scene) : scene;
        reference.shot.tracing.samples = samples;
        const RenderedFrame wanted = render(reference, path);
        if (method.is_grid())
            return against_halves(colours_of(frame.image, ""), wanted);
        Measured m = of_mean(frame, colours_of(wanted.image, ""), "", method);
        m.noise = std::hypot(m.noise, of_mean(wanted, colours_of(wanted.image, ""), "", path).noise);
        return m;
    };
}

}  // namespace brisance::stability
