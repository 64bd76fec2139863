// The files of `brisance report`: the page, and what lies beside it.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace brisance {

// The page that -o names. Throws Error Usage when it does not end in .html.
std::filesystem::path page_file(const std::string& output);

// The same name with another extension.
std::filesystem::path file_beside(const std::string& output, const char* extension);

// Throws Error Usage where one of the files is read as well, CannotCreate or OutputFailed where it cannot be written.
void check_report_files(const std::vector<std::filesystem::path>& files,
                        const std::vector<std::filesystem::path>& inputs);

void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& json);

}  // namespace brisance
