#include "machine.h"

#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <utility>

#include "core/parallel.h"

namespace brisance {
namespace {

std::string trimmed(const std::string& text) {
    const std::size_t begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
    return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

// Name and number of cores, from the kernel's list of logical processors.
void read_processors(Machine& machine) {
    std::ifstream in("/proc/cpuinfo");
    std::set<std::pair<std::string, std::string>> cores;  // package and core
    std::string package;
    for (std::string line; std::getline(in, line);) {
        const std::size_t colon = line.find(':');
        if (colon == std::string::npos)
            continue;
        const std::string name = trimmed(line.substr(0, colon)), value = trimmed(line.substr(colon + 1));
        if (name == "model name")
            machine.processor = value;
        else if (name == "physical id")
            package = value;
        else if (name == "core id")
            cores.insert({package, value});
    }
    machine.cores = static_cast<int>(cores.size());
}

}  // namespace

Machine this_machine() {
    Machine machine;
    read_processors(machine);
    machine.logical = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
    if (machine.processor.empty())
        machine.processor = "unknown processor";
    if (machine.cores == 0)
        machine.cores = machine.logical;
    machine.threads = thread_count();
    machine.memory_bytes =
        static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    if (getloadavg(machine.load.data(), 3) != 3)
        machine.load = {};
    utsname name{};
    if (uname(&name) == 0)
        machine.system = fmt::format("{} {} {}", name.sysname, name.release, name.machine);
    return machine;
}

}  // namespace brisance
