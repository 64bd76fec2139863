#include "scattering/series.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lights/voxel_lights.h"

namespace brisance {

namespace {

constexpr int kSingleOrders = 12;  // computed one by one before mixing begins
constexpr int kMostBounces = 96;
constexpr int kWindow = 6;  // iterates that mixing remembers

// Least squares over a small symmetric positive matrix, slightly regularised: nearly parallel iterates say nothing.
using Matrix = std::array<std::array<double, kWindow>, kWindow>;
std::array<double, kWindow> solved(Matrix a, std::array<double, kWindow> b, int n) {
    double trace = 0.0;
    for (int i = 0; i < n; ++i)
        trace += a[i][i];
    for (int i = 0; i < n; ++i)
        a[i][i] += 1e-12 * trace + 1e-300;
    for (int k = 0; k < n; ++k)
        for (int i = k + 1; i < n; ++i) {
            const double factor = a[i][k] / a[k][k];
            for (int j = k; j < n; ++j)
                a[i][j] -= factor * a[k][j];
            b[i] -= factor * b[k];
        }
    for (int k = n - 1; k >= 0; --k) {
        for (int j = k + 1; j < n; ++j)
            b[k] -= a[k][j] * b[j];
        b[k] /= a[k][k];
    }
    return b;
}

// One colour of two fields, each node as much as it scatters.
double inner(const NodeRadiance& a, const NodeRadiance& b, const std::vector<float>& weight, int colour) {
    double sum = 0.0;
    for (std::size_t i = 0; i < weight.size(); ++i) {
        double node = double(a.mean[i][colour]) * b.mean[i][colour];
        for (std::size_t k = 24 * i + colour; k < 24 * (i + 1) && !a.directional.empty(); k += 3)
            node += double(a.directional[k]) * b.directional[k];
        sum += weight[i] * node;
    }
    return sum;
}

NodeRadiance difference(const NodeRadiance& a, const NodeRadiance& b) {
    NodeRadiance d = a;
    d.add(b, Rgb(-1.0f));
    return d;
}

// Anderson mixing of x = g(x), colour by colour.
class Mixing {
public:
    explicit Mixing(const std::vector<float>& weight) : weight_(weight) {}

    // The next x, from the last one and g of it.
    NodeRadiance next(const NodeRadiance& x, const NodeRadiance& g) {
        NodeRadiance residual = difference(g, x);
        for (int c = 0; c < 3; ++c) {
            const double norm = inner(x, x, weight_, c);
            error_[c] = norm > 0.0 ? std::sqrt(inner(residual, residual, weight_, c) / norm) : 0.0;
        }
        NodeRadiance mixed = g;
        if (!residuals_.empty()) {
            remember(difference(residual, residuals_.back()), difference(g, images_.back()));
            subtract_past(residual, mixed);
        }
        residuals_.assign(1, std::move(residual));
        images_.assign(1, g);
        for (Rgb& v : mixed.mean)
            v = glm::max(v, Rgb(0.0f));
        return mixed;
    }

    // |g(x) - x| / |x| of the last step.
    double error(int colour) const { return error_[colour]; }

private:
    void remember(NodeRadiance residual_step, NodeRadiance image_step) {
        if (residual_steps_.size() == kWindow) {
            residual_steps_.erase(residual_steps_.begin());
            image_steps_.erase(image_steps_.begin());
        }
        residual_steps_.push_back(std::move(residual_step));
        image_steps_.push_back(std::move(image_step));
    }

    void subtract_past(const NodeRadiance& residual, NodeRadiance& mixed) const {
        const int n = static_cast<int>(residual_steps_.size());
        std::array<Rgb, kWindow> share{};
        for (int c = 0; c < 3; ++c) {
            Matrix a{};
            std::array<double, kWindow> b{};
            for (int i = 0; i < n; ++i) {
                b[i] = inner(residual_steps_[i], residual, weight_, c);
                for (int j = 0; j <= i; ++j)
                    a[i][j] = a[j][i] = inner(residual_steps_[i], residual_steps_[j], weight_, c);
            }
            const auto gamma = solved(a, b, n);
            for (int i = 0; i < n; ++i)
                share[i][c] = static_cast<float>(gamma[i]);
        }
        for (int i = 0; i < n; ++i)
            mixed.add(image_steps_[i], -share[i]);
    }

    const std::vector<float>& weight_;
    std::vector<NodeRadiance> residuals_, images_;  // of the last step
    std::vector<NodeRadiance> residual_steps_, image_steps_;
    std::array<double, 3> error_{};
};

class Series {
public:
    Series(CoarseOperator& op, const ScatteringSettings& settings, ScatteringCosts& costs, Progress& progress)
        : op_(op), settings_(settings), costs_(costs), progress_(progress) {}

    void run(Departure departure, int single_orders, const std::function<void(const NodeRadiance&)>& take) {
        start_ = previous_ = sum_power_ = total(departure.power);
        const int wanted = settings_.bounces < 0 ? kSingleOrders : single_orders;
        bool done = false;
        for (int k = 0; k < wanted && luminance(Rgb(previous_)) > 0.0f && !done; ++k) {
            const NodeRadiance order = bounce(departure, k + 1);
            take(order);
            sum_.add(order, Rgb(1.0f));
            if (k == 0)
                first_order_ = order;
            departure = op_.departure_of(order);
            done = settle(total(departure.power));
            last_ = order;
        }
        if (settings_.bounces >= 0 || costs_.bounces == 0)
            return;
        NodeRadiance tail;
        tail.add(last_, Rgb(tail_factor()));
        costs_.tail_share = share_of_tail();
        if (!done && costs_.remainder >= settings_.remainder)
            tail = difference(mix(tail), sum_);
        take(tail);
    }

private:
    NodeRadiance bounce(const Departure& departure, int order) {
        BounceBalance balance;
        balance.order = order;
        balance.emitted = luminance(Rgb(total(departure.power))) / luminance(Rgb(start_));
        NodeRadiance source = op_.bounce(departure, balance, costs_.levels, progress_);
        costs_.balances.push_back(balance);
        ++costs_.bounces;
        return source;
    }

    // Takes note of one more order's power. True: what is not known of the rest no longer matters.
    bool settle(const dvec3& now) {
        costs_.remainder = 0.0;
        for (int c = 0; c < 3; ++c) {
            if (!(previous_[c] > 0.0))
                continue;
            const double ratio = now[c] / previous_[c], drift = std::abs(ratio - ratio_[c]);
            sum_power_[c] += now[c];
            // The tail is now * ratio / (1 - ratio); a ratio still drifting leaves about this much of it unknown. One
            // small drift may be chance: the one before has its say.
            const double room = std::max(1.0 - ratio, 1e-6);
            const double unknown = now[c] * std::max(drift, 0.5 * drift_[c]) / (room * room) / sum_power_[c];
            costs_.remainder = std::max(costs_.remainder, unknown);
            ratio_[c] = ratio;
            drift_[c] = drift;
        }
        previous_ = now;
        costs_.tail_ratio = std::max({ratio_.x, ratio_.y, ratio_.z});
        progress_.fraction(std::min(1.0, settings_.remainder / std::max(costs_.remainder, 1e-9)));
        return settings_.bounces < 0 &&
               (costs_.remainder < settings_.remainder || luminance(Rgb(now)) < 1e-6f * luminance(Rgb(start_)));
    }

    dvec3 tail_factor() const {
        dvec3 factor(0.0);
        for (int c = 0; c < 3; ++c)
            if (ratio_[c] > 0.0)
                factor[c] = std::min(ratio_[c], 1.0 - 1e-6) / std::max(1.0 - ratio_[c], 1e-6);
        return factor;
    }

    double share_of_tail() const {
        const double tail = luminance(Rgb(tail_factor() * previous_));
        return tail / (luminance(Rgb(sum_power_)) + tail);
    }

    // The sum of all orders, starting from those computed and the tail guessed.
    NodeRadiance mix(const NodeRadiance& tail) {
        NodeRadiance x = sum_;
        x.add(tail, Rgb(1.0f));
        Mixing mixing(op_.weight());
        for (int small = 0; costs_.bounces < kMostBounces && small < 2;) {
            NodeRadiance g = bounce(op_.departure_of(x), -1);
            g.add(first_order_, Rgb(1.0f));
            x = mixing.next(x, g);
            costs_.remainder = 0.0;
            for (int c = 0; c < 3; ++c)
                costs_.remainder =
                    std::max(costs_.remainder, mixing.error(c) / std::max(1.0 - std::min(ratio_[c], 1.0), 1e-6));
            small = costs_.remainder < settings_.remainder ? small + 1 : 0;
            progress_.fraction(std::min(1.0, settings_.remainder / std::max(costs_.remainder, 1e-9)));
        }
        return x;
    }

    CoarseOperator& op_;
    const ScatteringSettings& settings_;
    ScatteringCosts& costs_;
    Progress& progress_;
    NodeRadiance first_order_, last_, sum_;
    dvec3 start_{0.0}, previous_{0.0}, sum_power_{0.0};  // per colour
    dvec3 ratio_{0.0}, drift_{0.0};
};

}  // namespace

void sum_orders(CoarseOperator& op, Departure first, const ScatteringSettings& settings, int single_orders,
                ScatteringCosts& costs, Progress& progress, const std::function<void(const NodeRadiance&)>& take) {
    Series(op, settings, costs, progress).run(std::move(first), single_orders, take);
}

}  // namespace brisance
