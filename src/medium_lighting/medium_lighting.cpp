#include "medium_lighting/medium_lighting.h"

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "medium_lighting/levels/lighting_level.h"

namespace brisance {

namespace {

void mix(std::vector<Rgb>& a, const std::vector<Rgb>& b, float share) {
    parallel_for(
        a.size(), [&](std::size_t i) { a[i] = glm::mix(a[i], b[i], share); }, 4096);
}

// An order that one of both has not counts as dark there: the last one holds the rest of the series.
void mix_orders(std::vector<std::vector<Rgb>>& a, std::vector<std::vector<Rgb>>&& b, float share) {
    for (std::size_t k = 0; k < std::max(a.size(), b.size()); ++k) {
        if (k == a.size())
            a.emplace_back(b[k].size(), Rgb(0.0f));
        mix(a[k], k < b.size() ? b[k] : std::vector<Rgb>(a[k].size(), Rgb(0.0f)), share);
    }
}

void mix(NodeLighting& a, NodeLighting&& b, float share) {
    for (auto field :
         {&NodeSources::single, &NodeSources::multiple, &NodeSources::from_surfaces, &NodeSources::from_emitters})
        mix(a.*field, b.*field, share);
    mix_orders(a.orders, std::move(b.orders), share);
}

LightingLevel level_of(const MediumLightingInput& input, Statistics& statistics) {
    const Stopwatch watch;
    const LightingLevel level = lighting_level(input);
    statistics.stages.push_back({"lattice of the light",
                                 watch.seconds(),
                                 0,
                                 {{"lattice_level", level.level},
                                  {"share_of_coarser_level", level.share_of_coarser},
                                  {"error", level.error},
                                  {"error_of_coarser_level", level.error_of_coarser}}});
    return level;
}

}  // namespace

MediumLighting::MediumLighting(const MediumLightingInput& input, Statistics& statistics, Progress& progress)
    : input_(input) {
    const LightingLevel level = level_of(input_, statistics);
    share_of_coarser_ = level.share_of_coarser;
    lighting_ = std::make_unique<LatticeLighting>(input_, level.level, statistics, progress);
    nodes_ = lighting_->take_nodes();
    if (!(share_of_coarser_ > 0.0f))
        return;
    Statistics costs;
    coarser_ = std::make_unique<LatticeLighting>(input_, level.level + 1, costs, progress);
    mix(nodes_, coarser_->take_nodes(), share_of_coarser_);
    for (StageCost& stage : costs.stages) {
        stage.name += ", on the next coarser lattice";
        statistics.stages.push_back(std::move(stage));
    }
}

void MediumLighting::at_surfaces(std::vector<SurfaceReceiver>& points) const {
    std::vector<SurfaceReceiver> coarse = coarser_ ? points : std::vector<SurfaceReceiver>{};
    lighting_->at_surfaces(points);
    if (!coarser_)
        return;
    coarser_->at_surfaces(coarse);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int part = 0; part < 2; ++part)
            for (auto light : {&SurfaceReceiver::fire, &SurfaceReceiver::smoke})
                (points[i].*light)[part] =
                    glm::mix((points[i].*light)[part], (coarse[i].*light)[part], share_of_coarser_);
}

}  // namespace brisance
