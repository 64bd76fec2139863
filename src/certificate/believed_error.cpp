#include "certificate/believed_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace brisance {

namespace {

// Errors between a thousandth of the expected one and a thousand times it, evenly in their logarithm.
constexpr int kErrorSteps = 1401, kMiddleStep = kErrorSteps / 2;
constexpr double kStep = 0.01;

double error_at(const ExpectedError& expected, int k) {
    return expected.error * std::exp(kStep * (k - kMiddleStep));
}

// Logarithm of the density of Student's t, up to a constant.
double log_student(double t, double degrees_of_freedom) {
    return -0.5 * (degrees_of_freedom + 1.0) * std::log1p(t * t / degrees_of_freedom);
}

// Logarithm of the probability density of the error, up to a constant, over its logarithm.
double log_density(const ExpectedError& expected, const CertifiedError* sampled, double error) {
    double out = log_student(std::log(error / expected.error) / expected.spread, kDegreesOfModel);
    if (sampled && std::isfinite(sampled->square) && sampled->square_deviation > 0.0 &&
        std::isfinite(sampled->square_deviation))
        out += log_student((sampled->square - error * error) / sampled->square_deviation,
                           std::max(sampled->degrees_of_freedom, 1.0));
    return out;
}

std::string in_percent(double value) {
    return fmt::format("{:.2g}", 100.0 * value);
}

const CertifiedError* certified(const Certificate& certificate, const std::string& cell) {
    for (const CertifiedError& e : certificate.errors)
        if (e.cell == cell)
            return &e;
    return nullptr;
}

// Unknown where the certificate cannot exclude an error of 0.
std::optional<double> ratio(const BelievedError& believed, const CertifiedError* e) {
    if (!e || !(e->error_interval.low > 0.0) || !std::isfinite(e->error_interval.high))
        return std::nullopt;
    return believed.error / e->error;
}

}  // namespace

BelievedError believed_error(const ExpectedError& expected, const CertifiedError* sampled) {
    BelievedError out{expected.cell, expected.error, {expected.error, expected.error}, expected.error};
    if (!(expected.error > 0.0) || !(expected.spread > 0.0))
        return out;
    std::array<double, kErrorSteps> upto;
    double largest = -1e300;
    for (int k = 0; k < kErrorSteps; ++k)
        largest = std::max(largest, upto[k] = log_density(expected, sampled, error_at(expected, k)));
    double sum = 0.0;
    for (double& v : upto)
        v = sum += std::exp(v - largest);
    const auto quantile = [&](double part) {
        const auto at = std::lower_bound(upto.begin(), upto.end(), part * sum);
        return error_at(expected, static_cast<int>(at - upto.begin()));
    };
    out.error = quantile(0.5);
    out.interval = {quantile(0.5 * (1.0 - kConfidence)), quantile(0.5 * (1.0 + kConfidence))};
    return out;
}

const BelievedError* Belief::of(const std::string& cell) const {
    const auto found = std::find_if(errors.begin(), errors.end(), [&](const auto& e) { return e.cell == cell; });
    return found == errors.end() ? nullptr : &*found;
}

nlohmann::ordered_json Belief::to_json(const Certificate* certificate) const {
    nlohmann::ordered_json json = {{"samples", samples}, {"pixels", pixels}};
    for (const BelievedError& e : errors) {
        nlohmann::ordered_json one = {
            {"error", e.error}, {"interval", {e.interval.low, e.interval.high}}, {"model", e.model}};
        const CertifiedError* const other = certificate ? certified(*certificate, e.cell) : nullptr;
        if (other) {
            one["certified"] = other->error;
            const std::optional<double> over = ratio(e, other);
            one["ratio"] = over ? nlohmann::ordered_json(*over) : nlohmann::ordered_json();
        }
        (e.cell.empty() ? json["picture"] : json["cells"][e.cell]) = one;
    }
    return json;
}

std::string Belief::line() const {
    std::string text;
    for (const BelievedError& e : errors)
        text += e.cell.empty()
                    ? fmt::format("{} % ({} to {} %)", in_percent(e.error), in_percent(e.interval.low),
                                  in_percent(e.interval.high))
                    : fmt::format("{} {} {} %", e.cell == errors[1].cell ? ";" : ",", e.cell, in_percent(e.error));
    return text;
}

std::string Belief::ratios(const Certificate& certificate) const {
    std::string text;
    for (const BelievedError& e : errors)
        if (const std::optional<double> over = ratio(e, certified(certificate, e.cell)))
            text += fmt::format("{}{} {:.2f}", text.empty() ? "" : ", ", e.cell.empty() ? "picture" : e.cell, *over);
    return text.empty() ? text : "believed over certified: " + text;
}

}  // namespace brisance
