#include "emitters/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "emitters/texel_means.h"

namespace brisance {

namespace {

using std::numbers::pi;

// Directions drawn evenly over the sphere, so that no light is missed for rounding.
constexpr double kEven = 0.05;

// The axes of a picture whose top is z: x at its centre, y at its left.
dmat3 axes(const LightSettings& light) {
    const bool z_up = light.up != 'y';
    const dvec3 up = z_up ? dvec3(0, 0, 1) : dvec3(0, 1, 0), left = z_up ? dvec3(0, 1, 0) : dvec3(0, 0, -1);
    const double turn = light.rotate_degrees * pi / 180.0;
    const dvec3 x(1, 0, 0), middle = std::cos(turn) * x + std::sin(turn) * left;
    return glm::transpose(dmat3(middle, glm::cross(up, middle), up));
}

dvec3 uniform_direction(double u, double v) {
    const double z = 1.0 - 2.0 * u, r = std::sqrt(std::max(0.0, 1.0 - z * z));
    return {r * std::cos(2.0 * pi * v), r * std::sin(2.0 * pi * v), z};
}

// Where a number falls in a cumulative distribution: the step, and how far into it.
struct Step {
    std::size_t index;
    double inside;
};

Step step_at(const double* begin, const double* end, double u) {
    const double* found = std::min(std::upper_bound(begin, end, u), end - 1);
    const double low = found == begin ? 0.0 : found[-1], width = *found - low;
    return {static_cast<std::size_t>(found - begin), width > 0.0 ? std::clamp((u - low) / width, 0.0, 1.0) : 0.5};
}

}  // namespace

Environment::Environment(const LightSettings& light, const Texture* picture)
    : picture_(picture), factor_(light.power), picture_from_world_(axes(light)) {
    if (!picture)
        return;
    const int width = picture->width, height = picture->height;
    std::vector<float> texels;
    texels.reserve(std::size_t(width) * height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Rgb c = factor_ * Rgb(picture->at({(x + 0.5f) / float(width), (y + 0.5f) / float(height)}));
            texels.push_back(std::max(0.0f, luminance(c)));
        }
    if (!picture->nearest)
        texels = texel_means(texels, width, height);
    columns_.resize(std::size_t(width) * height);
    double total = 0.0;
    for (int y = 0; y < height; ++y) {
        const double sine = std::sin(pi * (y + 0.5) / height);
        double row = 0.0;
        for (int x = 0; x < width; ++x) {
            row += texels[std::size_t(y) * width + x] * sine;
            columns_[std::size_t(y) * width + x] = row;
        }
        for (int x = 0; x < width && row > 0.0; ++x)
            columns_[std::size_t(y) * width + x] /= row;
        rows_.push_back(total += row);
    }
    if (!(total > 0.0))
        rows_.clear();
    for (double& row : rows_)
        row /= total;
}

vec2 Environment::picture_of(const dvec3& direction) const {
    const dvec3 d = picture_from_world_ * direction;
    const double u = 0.5 - std::atan2(d.y, d.x) / (2.0 * pi), v = std::acos(std::clamp(d.z, -1.0, 1.0)) / pi;
    return {float(u), float(v)};
}

dvec3 Environment::direction_of(double u, double v) const {
    const double azimuth = (0.5 - u) * 2.0 * pi, polar = v * pi;
    return glm::transpose(picture_from_world_) *
           dvec3(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar));
}

Rgb Environment::radiance(const dvec3& direction) const {
    return picture_ ? factor_ * Rgb(picture_->at(picture_of(direction))) : factor_;
}

dvec3 Environment::sample(double u, double v) const {
    if (rows_.empty() || u < kEven)
        return uniform_direction(rows_.empty() ? u : u / kEven, v);
    const Step row = step_at(rows_.data(), rows_.data() + rows_.size(), (u - kEven) / (1.0 - kEven));
    const std::size_t width = picture_->width;
    const double* columns = &columns_[row.index * width];
    const Step column = step_at(columns, columns + width, v);
    return direction_of((double(column.index) + column.inside) / double(width),
                        (double(row.index) + row.inside) / picture_->height);
}

double Environment::pdf(const dvec3& direction) const {
    const double even = 1.0 / (4.0 * pi);
    if (rows_.empty())
        return even;
    const vec2 at = picture_of(direction);
    const int width = picture_->width, height = picture_->height;
    const int x = std::clamp(static_cast<int>(at.x * float(width)), 0, width - 1);
    const int y = std::clamp(static_cast<int>(at.y * float(height)), 0, height - 1);
    const double* columns = &columns_[std::size_t(y) * width];
    const double row = rows_[y] - (y > 0 ? rows_[y - 1] : 0.0), column = columns[x] - (x > 0 ? columns[x - 1] : 0.0);
    const double sine = std::max(std::sin(pi * double(at.y)), 1e-9);
    return kEven * even + (1.0 - kEven) * row * column * width * height / (2.0 * pi * pi * sine);
}

}  // namespace brisance
