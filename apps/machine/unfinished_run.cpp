#include "apps/machine/unfinished_run.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

namespace taktwerk::apps {
namespace {

struct Mark {
    std::string boot;
    long process = 0;
    std::string since;  // when that process began, or its number might be another's by now
};

/// Field 22 of /proc/PID/stat; empty: there is no such process. Its name, in brackets, may hold anything.
std::string began(long process) {
    std::ifstream file(fmt::format("/proc/{}/stat", process));
    std::string line;
    std::getline(file, line);
    const auto behind = line.rfind(')');
    if (behind == std::string::npos) return {};
    std::istringstream rest(line.substr(behind + 1));
    std::string field;
    for (int i = 3; i <= 22; ++i) rest >> field;
    return field;
}

std::optional<Mark> read(const std::string& path) {
    std::ifstream file(path);
    Mark mark;
    if (!(file >> mark.boot >> mark.process >> mark.since) || mark.process <= 0) return std::nullopt;
    return mark;
}

}  // namespace

Result<UnfinishedRun> UnfinishedRun::begin(std::string path, const std::string& boot) {
    std::optional<Before> before;
    if (const auto mark = read(path); mark && mark->boot == boot) {
        // It runs still: that machine's socket and bus are taken, and this run will end before it moves anything.
        if (began(mark->process) == mark->since) return UnfinishedRun{std::string{}, std::nullopt};
        before = Before{mark->process};
    }
    std::ofstream file(path, std::ios::trunc);
    file << (boot.empty() ? "-" : boot) << ' ' << ::getpid() << ' ' << began(::getpid()) << '\n';
    if (!file.flush())
        return Error{"run.mark", path, fmt::format("the mark of this run cannot be written: {}", std::strerror(errno)),
                     "The machine runs; but if it crashes, the next start will not know, and begins as its file says."};
    return UnfinishedRun{std::move(path), before};
}

void UnfinishedRun::ended() noexcept {
    if (!path_.empty()) ::unlink(path_.c_str());
}

std::string boot_of_this_computer() {
    std::ifstream file("/proc/sys/kernel/random/boot_id");
    std::string boot;
    file >> boot;
    return boot;
}

}  // namespace taktwerk::apps
