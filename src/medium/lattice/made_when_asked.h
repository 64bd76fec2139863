// Records, such as those of bricks, that are made when a thread first asks for them.
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

namespace brisance {

template <class Records>
class MadeWhenAsked {
public:
    explicit MadeWhenAsked(std::size_t count) : made_(count) {}
    ~MadeWhenAsked() {
        for (const Place& place : made_)
            delete place.load(std::memory_order_relaxed);
    }
    MadeWhenAsked(const MadeWhenAsked&) = delete;
    MadeWhenAsked& operator=(const MadeWhenAsked&) = delete;

    // Null: not made yet.
    const Records* find(std::size_t i) const { return made_[i].load(std::memory_order_acquire); }

    // make() returns a std::unique_ptr. Threads that make the same records at once make them alike; one of them is
    // kept.
    template <class Make>
    const Records& get(std::size_t i, const Make& make) const {
        if (const Records* const made = find(i))
            return *made;
        std::unique_ptr<const Records> out = make();
        const Records* kept = nullptr;
        if (made_[i].compare_exchange_strong(kept, out.get(), std::memory_order_acq_rel))
            kept = out.release();
        return *kept;
    }

    std::size_t made() const {
        return static_cast<std::size_t>(std::count_if(made_.begin(), made_.end(), [](const Place& place) {
            return place.load(std::memory_order_relaxed) != nullptr;
        }));
    }
    std::size_t bytes_of_places() const { return made_.size() * sizeof(Place); }

private:
    using Place = std::atomic<const Records*>;
    mutable std::vector<Place> made_;
};

}  // namespace brisance
