// The two sides of reading a file: the child serves requests, its parent asks.
#include "volume/vdb_file.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <mutex>
#include <new>
#include <stdexcept>

#include "core/error.h"
#include "core/printable.h"
#include "volume/child/read_limits.h"
#include "volume/child/voxel_transport.h"
#include "volume/vdb_header.h"

namespace brisance {
namespace {

enum class Question : std::uint32_t { List, Load, Values };

struct Request {
    Question question = Question::List;
    std::uint32_t grid = 0;
    std::uint64_t memory_limit_bytes = 0;
};

enum class Outcome : std::uint32_t { Value, Failure };

// The child's side.
class Clerk {
public:
    Clerk(const std::filesystem::path& file, const Desk& desk, const Line& line)
        : file_(file), desk_(desk), line_(line) {}

    void serve() {
        Request request;
        while (line_.receive(&request, sizeof(request))) {
            if (request.question == Question::Values) {
                send_values(loaded_.voxels.value(), desk_.halves(), line_);
                continue;
            }
            answer(request);
            const char done = 0;
            line_.send(&done, 1);
        }
    }

private:
    void answer(const Request& request) {
        try {
            SharedWriter out(desk_.answer());
            out.put(Outcome::Value);
            request.question == Question::List ? put_list(out) : put_loaded(request, out);
        } catch (const Error& error) {
            put_failure(error.code(), error.what());
        } catch (const std::bad_alloc&) {
            put_failure(ExitCode::BadData, file_.string() +
                                               ": damaged VDB: it asks for far more memory than a file of its size "
                                               "needs; write or copy the file again");
        }
    }

    void put_list(SharedWriter& out) {
        open_ = open_vdb(file_);
        const std::vector<GridInfo> grids = open_->grids();
        out.put<std::uint64_t>(grids.size());
        for (const GridInfo& info : grids)
            put_info(out, info);
    }

    void put_loaded(const Request& request, SharedWriter& out) {
        loaded_ = {};
        loaded_ = open_->load(request.grid, request.memory_limit_bytes);
        put_grid(out, loaded_);
    }

    void put_failure(ExitCode code, const std::string& message) const {
        SharedWriter out(desk_.answer());
        out.put(Outcome::Failure);
        out.put(code);
        out.put_text(message);
    }

    std::filesystem::path file_;
    const Desk& desk_;
    const Line& line_;
    std::unique_ptr<OpenVdb> open_;
    LoadedGrid loaded_;
};

// The child may end while it holds a tree: to free that would take time for nothing.
void serve(const std::filesystem::path& file, const Desk& desk, const Line& line) {
    auto* const clerk = new Clerk(file, desk, line);
    clerk->serve();
}

ChildLimits limits_for(const std::filesystem::path& file) {
    static std::once_flag once;
    std::call_once(once, initialize_openvdb);
    return read_limits(read_vdb_header(file).file_bytes);
}

}  // namespace

// The parent's side.
class VdbReader::Session {
public:
    explicit Session(const std::filesystem::path& file)
        : file_(file.string()),
          limits_(limits_for(file)),
          desk_(limits_.memory_bytes),
          child_(limits_, [&](const Line& line) { serve(file, desk_, line); }) {
        ask({Question::List, 0, 0});
        answer([&](SharedReader& in) {
            for (auto left = in.get<std::uint64_t>(); left > 0; --left)
                grids_.push_back(get_info(in));
        });
    }

    const std::vector<GridInfo>& grids() const { return grids_; }
    // Whether another child must answer: this one ended, or met damage that may have changed its memory.
    bool spent() const { return spent_; }

    std::size_t find(const std::string& name, int index) const {
        std::string present;
        for (std::size_t k = 0; k < grids_.size(); ++k) {
            if (grids_[k].name == name && grids_[k].index == index)
                return k;
            present += fmt::format("{}\"{}[{}]\"", k > 0 ? ", " : "", printable(grids_[k].name, kLongestName),
                                   grids_[k].index);
        }
        throw Error(ExitCode::BadData, fmt::format("{}: no grid \"{}[{}]\"; name one of {}", file_,
                                                   printable(name, kLongestName), index, present));
    }

    ReceivedGrid load(std::size_t k, std::uint64_t memory_limit_bytes) {
        ask({Question::Load, static_cast<std::uint32_t>(k), memory_limit_bytes});
        ReceivedGrid grid;
        answer([&](SharedReader& in) { grid = get_grid(in, turns()); });
        return grid;
    }

    std::string where(std::size_t k) const {
        return fmt::format("{}: grid \"{}[{}]\"", file_, printable(grids_[k].name, kLongestName), grids_[k].index);
    }

private:
    // A child that ended is noticed where its answer is awaited.
    void ask(const Request& request) const { child_.line().send(&request, sizeof(request)); }

    void await() {
        char done = 0;
        if (child_.line().receive(&done, 1))
            return;
        spent_ = true;
        throw_end(child_.wait());
    }

    Turns turns() {
        return {[this] {
                    ask({Question::Values, 0, 0});
                },
                [this] { await(); },
                [this] {
                    const char free = 0;
                    child_.line().send(&free, 1);
                },
                desk_.halves()};
    }

    template <class Get>
    void answer(const Get& get) {
        await();
        try {
            SharedReader in(desk_.answer());
            if (in.get<Outcome>() == Outcome::Value)
                return get(in);
            spent_ = true;
            const auto code = in.get<ExitCode>();
            throw Error(code, in.get_text());
        } catch (const std::out_of_range&) {
            spent_ = true;
            throw_end(ChildEnd::Crashed);
        }
    }

    [[noreturn]] void throw_end(ChildEnd end) const {
        if (end == ChildEnd::Killed)
            throw Error(ExitCode::Temporary,
                        fmt::format("{}: the process that read it was killed, as the system does when memory runs out; "
                                    "free memory or try a larger machine",
                                    file_));
        const std::string what =
            end == ChildEnd::OutOfTime
                ? fmt::format("reading it takes more than {} s, too long for a file of its size", limits_.seconds)
                : "OpenVDB crashes on it";
        throw Error(ExitCode::BadData, fmt::format("{}: damaged VDB: {}; write or copy the file again", file_, what));
    }

    std::string file_;
    ChildLimits limits_;
    Desk desk_;
    ChildProcess child_;
    std::vector<GridInfo> grids_;
    bool spent_ = false;
};

double GridInfo::voxel_volume() const {
    return std::abs(glm::determinant(dmat3(world_from_index)));
}

VdbReader::VdbReader(const std::filesystem::path& file)
    : file_(file), session_(std::make_unique<Session>(file)), grids_(session_->grids()) {}

VdbReader::~VdbReader() = default;

// One damaged grid neither hides the others nor changes their voxels.
void VdbReader::start_again_if_spent() {
    if (session_->spent())
        session_ = std::make_unique<Session>(file_);
}

BlockGrid VdbReader::read(const std::string& name, int index, std::uint64_t memory_limit_bytes) {
    start_again_if_spent();
    const std::size_t k = session_->find(name, index);
    const GridInfo& info = session_->grids()[k];
    if (!info.usable)
        throw Error(ExitCode::BadData, fmt::format("{} {}", session_->where(k), info.why_unusable));
    const ReceivedGrid grid = session_->load(k, memory_limit_bytes);
    if (!grid.voxels)
        throw Error(ExitCode::BadData, fmt::format("{}: its tree is not of the standard shape; write it again with "
                                                   "OpenVDB's default tree",
                                                   session_->where(k)));
    return expand_blocks(*grid.voxels, info, memory_limit_bytes, session_->where(k));
}

GridCensus VdbReader::census(const std::string& name, int index, int bins) {
    start_again_if_spent();
    const std::size_t k = session_->find(name, index);
    const ReceivedGrid grid = session_->load(k, std::numeric_limits<std::uint64_t>::max());
    return grid.voxels ? count_voxels(*grid.voxels, bins) : grid.census;
}

std::vector<GridInfo> list_grids(const std::filesystem::path& file) {
    return VdbReader(file).grids();
}

BlockGrid read_grid(const std::filesystem::path& file, const std::string& name, int index,
                    std::uint64_t memory_limit_bytes) {
    return VdbReader(file).read(name, index, memory_limit_bytes);
}

GridCensus census_of_grid(const std::filesystem::path& file, const std::string& name, int index, int bins) {
    return VdbReader(file).census(name, index, bins);
}

}  // namespace brisance
