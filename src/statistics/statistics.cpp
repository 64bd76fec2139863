#include "statistics/statistics.h"

#include <iomanip>
#include <sstream>

namespace brisance {

nlohmann::ordered_json Statistics::to_json() const {
    nlohmann::ordered_json json;
    json["cells"] = cells;
    json["skipped"] = nlohmann::ordered_json::array();
    for (const SkippedPart& s : skipped)
        json["skipped"].push_back({{"part", s.name}, {"reason", s.reason}});
    json["stages"] = nlohmann::ordered_json::array();
    for (const StageCost& s : stages) {
        nlohmann::ordered_json stage = {{"name", s.name}, {"seconds", s.seconds}, {"bytes", s.bytes}};
        if (!s.detail.is_null())
            stage["detail"] = s.detail;
        json["stages"].push_back(std::move(stage));
    }
    if (!believed_error.is_null())
        json["believed_error"] = believed_error;
    if (!certificate.is_null())
        json["certificate"] = certificate;
    json["warnings"] = warnings;
    json["notices"] = notices;
    json["seconds"] = seconds;
    json["peak_resident_bytes"] = peak_resident_bytes;
    return json;
}

namespace {

void list_levels(std::ostringstream& out, const nlohmann::ordered_json& levels) {
    out << "      level     lights   maps            map MiB   map s   gather s   evaluations\n";
    for (const auto& l : levels) {
        std::string maps = "-";
        if (l["resolution"].get<int>() > 0)
            maps = std::to_string(l["resolution"].get<int>()) + "^2 x " + std::to_string(l["distances"].get<int>());
        out << "      " << std::setw(5) << l["level"].get<int>() << std::setw(11) << l["lights"].get<std::size_t>()
            << "   " << std::left << std::setw(13) << maps << std::right << std::setw(10)
            << l["map_bytes"].get<double>() / (1 << 20) << std::setw(8) << l["map_seconds"].get<double>()
            << std::setw(11) << l["gather_seconds"].get<double>() << std::setw(14)
            << l["evaluations"].get<std::uint64_t>() << "\n";
    }
}

// Everything in a row is measured: collisions are gathered, and rays with no part in the scale find what escapes.
void list_balances(std::ostringstream& out, const nlohmann::ordered_json& balances) {
    out << "      energy: orders   emitted   collided x scale   + escaped (+- standard error)   = sum\n"
        << std::setprecision(4);
    for (const auto& b : balances)
        out << "            " << std::setw(8) << b["orders"].get<std::string>() << std::setw(10)
            << b["emitted"].get<double>() << std::setw(11) << b["collided"].get<double>() << " x "
            << b["scale"].get<double>() << "   + " << b["escaped"].get<double>() << " (+- "
            << b["escape_standard_error"].get<double>() << ")   = " << b["sum"].get<double>() << "\n";
    out << std::setprecision(2);
}

}  // namespace

std::string Statistics::explain() const {
    std::ostringstream out;
    out << std::fixed << std::setprecision(2);
    out << "cells:";
    for (const std::string& c : cells)
        out << " " << c;
    out << (cells.empty() ? " none: a black frame, with alpha\n" : "\n");
    for (const SkippedPart& s : skipped)
        out << "  left out  " << s.name << ": " << s.reason << "\n";
    for (const StageCost& s : stages) {
        out << "  " << std::setw(8) << s.seconds << " s" << std::setw(10) << s.bytes / double(1 << 20) << " MiB  "
            << s.name << "\n";
        if (s.detail.contains("levels"))
            list_levels(out, s.detail["levels"]);
        if (s.detail.contains("balance"))
            list_balances(out, s.detail["balance"]);
        for (const auto& [key, value] : s.detail.items())
            if (value.is_primitive())
                out << "      " << key << ": " << value.dump() << "\n";
    }
    if (seconds > 0.0)
        out << "  " << std::setw(8) << seconds << " s in all, peak memory " << peak_resident_bytes / double(1 << 20)
            << " MiB\n";
    return out.str();
}

}  // namespace brisance
