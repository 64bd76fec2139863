#include "photon_density/photon_density.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "light_selection/progressive_radius.h"

namespace brisance {

namespace {

constexpr Stream kPasses = stream_of("photon_density/pass");

// Relative to the medium's diagonal.
constexpr double kLongestPiece = 1.0 / 24.0;
// Of flights beyond the smoke, in longest pieces: as far as the smoke is wide.
constexpr double kMostMargin = 24.0;
// Photons within the automatic radius of a ray, or of one of its points, if they were distributed uniformly.
constexpr double kAroundRay = 64.0, kAroundPoint = 32.0;
// Photons around a point of a surface, however many passes.
constexpr int kFewestNeighbours = 4;

double longest_piece(const TrackingField& field) {
    const dvec3 nodes(field.bricks().brick_extent() * BrickLattice::kSize);
    return kLongestPiece * glm::length(dmat3(field.medium().world_from_index) * nodes);
}

// Where photons are distributed uniformly over the smoke: N points, beams of length L together in a volume V, of which
// a ray sees a length s. Around a point there are 4 pi r^3 N / (3 V) points, around a ray pi r^2 s N / V, and lines of
// any direction pass a ray within r in 2 r s (pi / 4) L / V places. A ray sees the width of the smoke as far as its
// mean free path L / N allows. A sharp phase function shows few of the photons: as many as noise would say are
// 1 / mean((4 pi p)^2) of all, which is (1 - g^2)^2 / (1 + g^2), and so many more are taken.
double automatic_radius(DensityEstimator estimator, const std::vector<PhotonFlight>& flights, double volume,
                        double mean_cosine) {
    double points = 0.0, length = 0.0;
    for (const PhotonFlight& flight : flights) {
        points += flight.collides;
        length += flight.length;
    }
    if (!(length > 0.0))
        return std::numeric_limits<double>::infinity();
    const double width = std::cbrt(volume), depth = width * points / length;
    const double seen = depth > 0.0 ? width * (-std::expm1(-depth) / depth) : width;
    const double g2 = mean_cosine * mean_cosine, more = (1.0 + g2) / std::max((1.0 - g2) * (1.0 - g2), 1e-12);
    constexpr double kPi = std::numbers::pi;
    switch (estimator) {
        case DensityEstimator::PointPoint:
            return std::cbrt(more * kAroundPoint * 3.0 * volume / (4.0 * kPi * std::max(points, 1.0)));
        case DensityEstimator::PointBeam:
            return std::sqrt(more * kAroundRay * volume / (kPi * seen * std::max(points, 1.0)));
        case DensityEstimator::BeamBeam:
            break;
    }
    return more * kAroundRay * volume / (0.5 * kPi * seen * length);
}

}  // namespace

int blurred_dimensions(DensityEstimator estimator) {
    return estimator == DensityEstimator::PointPoint ? 3 : (estimator == DensityEstimator::PointBeam ? 2 : 1);
}

PhotonDensitySettings settings_of_pass(PhotonDensitySettings settings, int pass, double first) {
    if (pass == 0)
        return settings;
    const int dimensions = blurred_dimensions(settings.estimator);
    const bool fastest = settings.alpha == kFastestAlpha;
    settings.radius = first * radius_shrunk(pass, fastest ? fastest_alpha(dimensions) : settings.alpha, dimensions);
    const double disc = std::pow(radius_shrunk(pass, fastest ? fastest_alpha(2) : settings.alpha, 2), 2);
    settings.neighbours = std::max(std::min(settings.neighbours, kFewestNeighbours),
                                   static_cast<int>(std::lround(settings.neighbours * disc)));
    Rng rng(kPasses, settings.seed, static_cast<std::uint64_t>(pass));
    settings.seed = static_cast<std::uint32_t>(rng.next_double() * 0x1p32);
    return settings;
}

PhotonDensity::PhotonDensity(const DirectLight& scene, const PhotonDensitySettings& settings, int bounces,
                             const dvec3& eye)
    : InScattering(settings.seed),
      scene_(scene),
      settings_(settings),
      longest_(longest_piece(scene.field())),
      photon_map_(store(trace_photons(scene, settings, std::clamp(settings.radius, longest_, kMostMargin * longest_),
                                      bounces, report_),
                        eye)) {}

std::vector<SurfacePhoton> PhotonDensity::store(TracedPhotons photons, const dvec3& eye) {
    report_.radius = settings_.radius;
    if (settings_.radius == kAutomaticBlur)
        report_.radius =
            std::min(longest_, automatic_radius(settings_.estimator, photons.flights, scene_.field().smoke_volume(),
                                                scene_.field().mean_cosine()));
    if (settings_.estimator == DensityEstimator::BeamBeam)
        beams_ = PhotonBeams(photons.flights, radius(), std::max(longest_, radius()));
    else
        points_ = PhotonPoints(scene_.field(), photons.flights, radius(),
                               settings_.estimator == DensityEstimator::PointBeam, eye);
    report_.stored = points_.size() + beams_.size();
    report_.surface_photons = photons.landed.size();
    return std::move(photons.landed);
}

Rgb PhotonDensity::along_ray(const RayMedium& seen, Rng& rng, SelectionCost*) const {
    if (seen.empty())
        return Rgb(0.0f);
    const double g = scene_.field().mean_cosine();
    switch (settings_.estimator) {
        case DensityEstimator::PointPoint:
            return points_.around(seen, g, rng);
        case DensityEstimator::PointBeam:
            return points_.along(seen, g);
        case DensityEstimator::BeamBeam:
            break;
    }
    return beams_.along(seen, g);
}

Rgb PhotonDensity::at_surface(const SurfacePoint& point, const ReceiverLobes& lobes, const dvec3& toward_viewer, Rng&,
                              SelectionCost*) const {
    return photon_map_.scattered(point, lobes.whole, toward_viewer, settings_.neighbours);
}

}  // namespace brisance
