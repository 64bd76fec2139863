#include "report_files.h"

#include <fmt/format.h>

#include <system_error>

#include "core/error.h"
#include "film/whole_file.h"
#include "film/write_image.h"

namespace brisance {

namespace fs = std::filesystem;

fs::path page_file(const std::string& output) {
    if (fs::path(output).extension() != ".html")
        throw Error(ExitCode::Usage, fmt::format("-o names the page and must end in .html: {}", output));
    return output;
}

fs::path file_beside(const std::string& output, const char* extension) {
    return fs::path(output).replace_extension(extension);
}

void check_report_files(const std::vector<fs::path>& files, const std::vector<fs::path>& inputs) {
    for (const fs::path& file : files) {
        for (const fs::path& input : inputs) {
            std::error_code error;
            if (fs::equivalent(file, input, error))
                throw Error(ExitCode::Usage,
                            fmt::format("{} is read and would be overwritten; choose another -o", file.string()));
        }
        check_writable(file);
    }
}

void write_json(const fs::path& file, const nlohmann::ordered_json& json) {
    write_text(file, json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace brisance
