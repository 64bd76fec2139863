#include "stability/closed_forms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace brisance::stability {

double integrate(const std::function<double(double)>& f, double begin, double end, int steps) {
    double sum = 0.0;
    for (int i = 0; i < steps; ++i)
        sum += f(begin + (i + 0.5) * (end - begin) / steps);
    return sum * (end - begin) / steps;
}

double one_minus_transmittance(double depth) {
    return -std::expm1(-depth);
}

double chandrasekhar_h(double albedo, double mu) {
    // m = u^2 crowds the points where H bends.
    constexpr int kPoints = 400;
    std::vector<double> m(kPoints), weight(kPoints), h(kPoints, 1.0);
    for (int i = 0; i < kPoints; ++i) {
        const double u = (i + 0.5) / kPoints;
        m[i] = u * u;
        weight[i] = 2.0 * u / kPoints;
    }
    const auto next = [&](double at) {
        double sum = 0.0;
        for (int i = 0; i < kPoints; ++i)
            sum += weight[i] * m[i] * h[i] / (at + m[i]);
        return 1.0 / (std::sqrt(1.0 - albedo) + 0.5 * albedo * sum);
    };
    for (int sweep = 0; sweep < 200; ++sweep)
        for (int i = 0; i < kPoints; ++i)
            h[i] = 0.5 * (h[i] + next(m[i]));
    return next(mu);
}

double isothermal_half_space(double albedo, double mu) {
    return std::sqrt(1.0 - albedo) * chandrasekhar_h(albedo, mu);
}

namespace {

struct Exponentials {
    double e2, e3;
};

// Exponential integrals E_2 and E_3.
Exponentials exponentials(double x) {
    if (x <= 0.0)
        return {1.0, 0.5};
    const double e = std::exp(-x), e1 = x > 700.0 ? 0.0 : -std::expint(-x);
    const double e2 = e - x * e1;
    return {e2, 0.5 * (e - x * e2)};
}

// Integrals over [a, b] of E1|x - y| times the hats that are 1 at a and at b; x is not inside.
void add_segment(double x, double a, double b, double& at_a, double& at_b) {
    const double near = std::min(std::abs(x - a), std::abs(x - b)), far = std::max(std::abs(x - a), std::abs(x - b));
    const Exponentials n = exponentials(near), f = exponentials(far);
    const double zeroth = n.e2 - f.e2;
    const double first = (near * n.e2 + n.e3) - (far * f.e2 + f.e3);  // of E1(u) u
    const double toward_far = (first - near * zeroth) / (far - near);
    (x <= a ? at_b : at_a) += toward_far;
    (x <= a ? at_a : at_b) += zeroth - toward_far;
}

// Gaussian elimination with row pivots; the matrix is destroyed.
std::vector<double> solved(std::vector<std::vector<double>>& a, std::vector<double> b) {
    const std::size_t n = b.size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k + 1; i < n; ++i)
            if (std::abs(a[i][k]) > std::abs(a[pivot][k]))
                pivot = i;
        std::swap(a[k], a[pivot]);
        std::swap(b[k], b[pivot]);
        for (std::size_t i = k + 1; i < n; ++i) {
            const double factor = a[i][k] / a[k][k];
            if (factor == 0.0)
                continue;
            for (std::size_t j = k; j < n; ++j)
                a[i][j] -= factor * a[k][j];
            b[i] -= factor * b[k];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t j = k + 1; j < n; ++j)
            b[k] -= a[k][j] * b[j];
        b[k] /= a[k][k];
    }
    return b;
}

}  // namespace

ScatteringBall::ScatteringBall(double radius, double albedo, double emission) : radius_(radius) {
    constexpr int kCells = 160;
    // Points crowd toward the surface as the square of the number of cells that are left.
    for (int i = 0; i <= kCells; ++i) {
        const double left = double(kCells - i) / kCells;
        x_.push_back(radius * (1.0 - left * left));
    }
    const std::size_t n = x_.size();
    std::vector<std::vector<double>> matrix(n, std::vector<double>(n, 0.0));
    std::vector<double> wanted(n);
    for (std::size_t i = 0; i < n; ++i) {
        std::vector<double> row(n, 0.0), mirrored(n, 0.0);
        for (std::size_t k = 0; k + 1 < n; ++k) {
            add_segment(x_[i], x_[k], x_[k + 1], row[k], row[k + 1]);
            add_segment(-x_[i], x_[k], x_[k + 1], mirrored[k], mirrored[k + 1]);
        }
        for (std::size_t k = 0; k < n; ++k)
            matrix[i][k] = (i == k ? 1.0 : 0.0) - 0.5 * albedo * (row[k] - mirrored[k]);
        wanted[i] = emission * x_[i];
    }
    f_ = solved(matrix, wanted);
}

double ScatteringBall::source(double r) const {
    const std::size_t above =
        std::clamp<std::size_t>(std::upper_bound(x_.begin(), x_.end(), r) - x_.begin(), 1, x_.size() - 1);
    const double t = (r - x_[above - 1]) / (x_[above] - x_[above - 1]);
    const double f = f_[above - 1] + t * (f_[above] - f_[above - 1]);
    return r > x_[1] ? f / r : f_[1] / x_[1];
}

namespace {

// Integral over [0, depth] of S exp(-t) for t = depth behind the eye, in steps that are even in exp(-t).
double seen(double depth, const std::function<double(double)>& source) {
    const double opacity = one_minus_transmittance(depth);
    return opacity * integrate([&](double u) { return source(-std::log1p(-u * opacity)); }, 0.0, 1.0, 4000);
}

}  // namespace

double ScatteringBall::radiance(double impact) const {
    const double half = std::sqrt(std::max(0.0, radius_ * radius_ - impact * impact));
    return seen(2.0 * half, [&](double t) { return source(std::hypot(half - t, impact)); });
}

double ScatteringBall::radiance_from_centre() const {
    return seen(radius_, [&](double t) { return source(t); });
}

double ScatteringBall::power() const {
    return 2.0 * kExactPi * integrate([&](double b) { return radiance(b) * b; }, 0.0, radius_, 200);
}

double airlight(double extinction, double scattering, double begin, double end, double nearest, double offset) {
    // Equi-angular: t = nearest + offset tan(angle) takes 1 / r^2 out of the integrand.
    const auto angle = [&](double t) { return std::atan2(t - nearest, offset); };
    const auto integrand = [&](double a) {
        const double t = nearest + offset * std::tan(a), r = offset / std::cos(a);
        return std::exp(-extinction * (t - begin + r));
    };
    return scattering / (4.0 * kExactPi * offset) * integrate(integrand, angle(begin), angle(end), 4000);
}

double blackbody_luminance(double kelvin) {
    // CIE 1924, 380 to 770 nm in steps of 10.
    constexpr std::array v = {0.00004, 0.00012, 0.0004, 0.0012, 0.0040,  0.0116,  0.0230,  0.0380,  0.0600,  0.0910,
                              0.1390,  0.2080,  0.3230, 0.5030, 0.7100,  0.8620,  0.9540,  0.9950,  0.9950,  0.9520,
                              0.8700,  0.7570,  0.6310, 0.5030, 0.3810,  0.2650,  0.1750,  0.1070,  0.0610,  0.0320,
                              0.0170,  0.0082,  0.0041, 0.0021, 0.00105, 0.00052, 0.00025, 0.00012, 0.00006, 0.00003};
    double sum = 0.0;
    for (std::size_t i = 0; i < v.size(); ++i) {
        const double metres = (380.0 + 10.0 * i) * 1e-9;
        sum += v[i] * 1.191042972e-16 / (std::pow(metres, 5.0) * std::expm1(1.438776877e-2 / (metres * kelvin)));
    }
    return sum * 10e-9;
}

}  // namespace brisance::stability
