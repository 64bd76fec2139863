#include "retiming/choose_retiming.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.h"
#include "retiming/between_frames.h"
#include "retiming/common_lattice.h"

namespace brisance {
namespace {

constexpr std::size_t kPlaces = 5;

// Three neighbours on disk, the middle of which is predicted from the others.
struct Triple {
    std::array<int, 3> number;
    std::array<SourceFrame, 3> frame;
};

// Up to kPlaces of `count`, evenly spread.
std::vector<std::size_t> spread(std::size_t count) {
    const std::size_t n = std::min(count, kPlaces);
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < n; ++i)
        places.push_back((2 * i + 1) * count / (2 * n));
    return places;
}

std::vector<std::size_t> first_of_triples(const std::vector<int>& on_disk) {
    return spread(on_disk.size() < 3 ? 0 : on_disk.size() - 2);
}

std::vector<Triple> read_triples(const std::vector<int>& on_disk, const ReadFrame& read) {
    std::vector<Triple> triples;
    for (const std::size_t i : first_of_triples(on_disk)) {
        Triple triple{{on_disk[i], on_disk[i + 1], on_disk[i + 2]}, {}};
        for (std::size_t f = 0; f < 3; ++f)
            triple.frame[f] = read(triple.number[f]);
        triples.push_back(std::move(triple));
    }
    return triples;
}

std::vector<NeighbourFrames> neighbours(const RetimingQuestion& question, const std::vector<Triple>& triples,
                                        const ReadFrame& read) {
    std::vector<NeighbourFrames> pairs;
    for (const Triple& t : triples)
        pairs.push_back({t.number[0], t.number[1], t.frame[0], t.frame[1]});
    const std::vector<int>& on_disk = question.on_disk;
    if (pairs.empty() && on_disk.size() == 2)
        pairs.push_back({on_disk[0], on_disk[1], read(on_disk[0]), read(on_disk[1])});
    return pairs;
}

std::string why_no_motion(const RetimingChoice& choice) {
    return choice.fit ? "the velocity's unit cannot be told: " + choice.fit->why_not : "";
}

// Settles the unit. False: it cannot be told.
bool settle_unit(const RetimingQuestion& question, const std::vector<Triple>& triples, const ReadFrame& read,
                 RetimingChoice& choice) {
    if (question.velocity.unit != VelocityUnit::Automatic)
        return true;
    choice.fit = fit_velocity(neighbours(question, triples, read), question.role);
    if (!choice.fit->why_not.empty())
        return false;
    choice.velocity.unit = VelocityUnit::Frame;
    choice.velocity.scale *= choice.fit->metres_per_frame;
    choice.lines.push_back(
        fmt::format("velocity: {}; keep it with --set velocity.unit=frame --set velocity.scale={:.4g}",
                    choice.fit->describe(question.velocity.frames_per_second), choice.velocity.scale));
    return true;
}

BetweenFrames outer(const RetimingQuestion& question, const Triple& triple) {
    const double whole = triple.number[2] - triple.number[0];
    BetweenFrames pair{triple.frame[0], triple.frame[2], (triple.number[1] - triple.number[0]) / whole,
                       triple.number[2] - triple.number[0], question.where};
    for (SourceFrame* frame : {&pair.first, &pair.second})
        frame->fields = {frame->fields[question.role]};
    return pair;
}

void measure(const RetimingQuestion& question, const std::vector<Triple>& triples, bool moves, RetimingChoice& choice) {
    for (const Triple& triple : triples) {
        const std::optional<BlockGrid>& truth = triple.frame[1].fields[question.role];
        if (!truth || truth->empty())
            continue;
        const BetweenFrames pair = outer(question, triple);
        const auto error = [&](const Fields& fields) { return fields[0] ? relative_error(*fields[0], *truth) : 1.0; };
        choice.held_out.push_back(triple.number[1]);
        choice.linear_error += error(blended(pair));
        if (moves)
            choice.advect_error += error(advected(pair, choice.velocity));
    }
    for (double* sum : {&choice.linear_error, &choice.advect_error})
        *sum /= std::max<double>(1.0, double(choice.held_out.size()));
}

std::string frames_text(const std::vector<int>& frames) {
    std::string text;
    for (const int frame : frames)
        text += fmt::format("{}{}", text.empty() ? "" : ", ", frame);
    return text;
}

void decide(const RetimingQuestion& question, const std::vector<Triple>& triples, bool moves, std::string why_not,
            RetimingChoice& choice) {
    measure(question, triples, moves, choice);
    if (choice.held_out.empty() && why_not.empty())
        why_not = "no frame with two neighbours can be held out to compare";
    if (moves && !choice.held_out.empty() && choice.advect_error < choice.linear_error)
        choice.retime = Retime::Advect;
    std::string line = fmt::format("time: times between frames are made by retime={}",
                                   choice.retime == Retime::Advect ? "advect" : "linear");
    if (!choice.held_out.empty())
        line += fmt::format("; frames {} of \"{}\", made from their neighbours, are wrong by {:.3f} blended{}",
                            frames_text(choice.held_out), question.role_name, choice.linear_error,
                            moves ? fmt::format(" and {:.3f} advected", choice.advect_error) : "");
    if (!why_not.empty())
        line += "; " + why_not;
    choice.lines.push_back(line);
}

}  // namespace

double relative_error(const BlockGrid& field, const BlockGrid& truth) {
    const BlockGrid moved = on_lattice(field, truth.info.world_from_index);
    std::vector<ivec3> bricks;
    for (const BlockGrid* grid : {&moved, &truth})
        for (const ivec3& origin : grid->block_origin)
            bricks.push_back(origin >> 3);
    const BrickLattice lattice(std::move(bricks));
    const std::vector<float> a = values_on(lattice, &moved, truth.channels);
    const std::vector<float> b = values_on(lattice, &truth, truth.channels);
    double squares = 0.0, norm = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        squares += (double(a[i]) - b[i]) * (double(a[i]) - b[i]);
        norm += double(b[i]) * b[i];
    }
    return norm > 0.0 ? std::sqrt(squares / norm) : (squares > 0.0 ? 1.0 : 0.0);
}

std::vector<int> frames_looked_at(const std::vector<int>& on_disk) {
    if (on_disk.size() == 2)
        return on_disk;
    std::set<int> frames;
    for (const std::size_t i : first_of_triples(on_disk))
        frames.insert(on_disk.begin() + std::ptrdiff_t(i), on_disk.begin() + std::ptrdiff_t(i) + 3);
    return {frames.begin(), frames.end()};
}

RetimingChoice choose_retiming(const RetimingQuestion& question, const ReadFrame& read) {
    RetimingChoice choice;
    choice.velocity = question.velocity;
    const bool advect = question.retime == Retime::Advect;
    if (advect && !question.has_velocity)
        throw Error(ExitCode::BadData, fmt::format("{}: time.retime is advect, but {}; set time.retime to linear",
                                                   question.where, question.why_no_velocity));
    const std::vector<Triple> triples = read_triples(question.on_disk, read);
    const bool moves = question.has_velocity && settle_unit(question, triples, read, choice);
    const std::string why_not = question.has_velocity ? why_no_motion(choice) : question.why_no_velocity;
    if (advect && !moves)
        throw Error(ExitCode::BadData,
                    fmt::format("{}: {}; set velocity.unit and velocity.scale, or time.retime to linear",
                                question.where, why_not));
    choice.retime = advect ? Retime::Advect : Retime::Linear;
    if (!advect)
        decide(question, triples, moves, moves ? "" : why_not, choice);
    return choice;
}

UnitChoice choose_unit(const RetimingQuestion& question, const ReadFrame& read) {
    RetimingChoice choice;
    choice.velocity = question.velocity;
    if (settle_unit(question, read_triples(question.on_disk, read), read, choice))
        return {choice.velocity, choice.lines.empty() ? "" : choice.lines.front()};
    choice.velocity.unit = VelocityUnit::Frame;
    choice.velocity.scale = 0.0;
    return {choice.velocity, fmt::format("velocity: {}; the smoke is not blurred; set velocity.unit and velocity.scale",
                                         why_no_motion(choice))};
}

}  // namespace brisance
