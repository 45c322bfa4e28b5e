#include "apps/machine/unfinished_run.hpp"

#include <fcntl.h>
#include <sys/stat.h>
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

/// Nothing where there is none. One that nobody understands is of process 0.
std::optional<Mark> read(const std::string& path) {
    struct stat info {};
    if (::lstat(path.c_str(), &info) != 0 && errno == ENOENT) return std::nullopt;
    Mark mark;
    std::ifstream file;
    if (S_ISREG(info.st_mode)) file.open(path);
    if (!(file >> mark.boot >> mark.process >> mark.since) || mark.process <= 0) return Mark{};
    return mark;
}

/// The old mark or the new one, whenever this is killed. Not on the disk: a power cut is an ordinary start.
bool write(const std::string& path, const std::string& text) {
    const auto aside = path + ".new";
    ::unlink(aside.c_str());
    const int fd = ::open(aside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0644);
    if (fd < 0) return false;
    const auto put = ::write(fd, text.data(), text.size());
    const int failed = put < 0 ? errno : put != static_cast<ssize_t>(text.size()) ? ENOSPC : 0;
    ::close(fd);
    if (failed == 0 && ::rename(aside.c_str(), path.c_str()) == 0) return true;
    const int why = failed != 0 ? failed : errno;
    ::unlink(aside.c_str());
    errno = why;
    return false;
}

}  // namespace

UnfinishedRun UnfinishedRun::begin(std::string path, const std::string& boot) {
    std::optional<Before> before;
    if (const auto mark = read(path); mark && (mark->process == 0 || mark->boot == boot)) {
        // It runs still: that machine's socket and bus are taken, and this run will end before it moves anything.
        if (mark->process != 0 && began(mark->process) == mark->since) return UnfinishedRun{std::string{}, std::nullopt};
        before = Before{mark->process};
    }
    UnfinishedRun run{std::move(path), before};
    if (!write(run.path_, fmt::format("{} {} {}\n", boot.empty() ? "-" : boot, ::getpid(), began(::getpid()))))
        run.trouble_ = Error{"run.mark", run.path_, fmt::format("the mark of this run cannot be written: {}", std::strerror(errno)),
                             "The machine runs; but if it crashes, the next start will not know, and begins as its file says."};
    return run;
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
