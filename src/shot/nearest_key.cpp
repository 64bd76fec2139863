#include "shot/nearest_key.h"

#include <algorithm>
#include <limits>

namespace brisance {
namespace {

constexpr std::size_t kLongestKey = 200;

std::string last_part(const std::string& path) {
    return path.substr(path.rfind('.') + 1);
}

}  // namespace

int edit_distance(const std::string& a, const std::string& b) {
    // Rows of the dynamic programme: two back, one back, now ("optimal string alignment").
    std::vector<int> older(b.size() + 1), old(b.size() + 1), now(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
        old[j] = static_cast<int>(j);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        now[0] = static_cast<int>(i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            now[j] = std::min({old[j] + 1, now[j - 1] + 1, old[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                now[j] = std::min(now[j], older[j - 2] + 1);
        }
        older.swap(old);
        old.swap(now);
    }
    return old[b.size()];
}

std::string nearest_key(const std::string& given, const std::vector<std::string>& known) {
    const std::string path = given.substr(0, kLongestKey);  // the time goes with its length
    std::string nearest;
    int least = std::numeric_limits<int>::max();
    for (const std::string& candidate : known) {
        // A right name in the wrong section is a likelier mistake than two wrong letters.
        const int moved = edit_distance(last_part(path), last_part(candidate)) + 1;
        const int distance = std::min(edit_distance(path, candidate), moved);
        if (distance < least) {
            least = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

}  // namespace brisance
