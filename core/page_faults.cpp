#include "core/page_faults.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <cstdio>

namespace taktwerk {

ThreadPageFaults::ThreadPageFaults(int thread_id) : file_(-1) {
    std::array<char, 64> path{};
    std::snprintf(path.data(), path.size(), "/proc/self/task/%d/stat", thread_id);
    file_ = ::open(path.data(), O_RDONLY | O_CLOEXEC);
}

ThreadPageFaults::~ThreadPageFaults() {
    if (file_ >= 0) ::close(file_);
}

std::optional<PageFaults> ThreadPageFaults::read() const {
    std::array<char, 1024> text{};
    const auto got = file_ < 0 ? -1 : ::pread(file_, text.data(), text.size(), 0);
    return got <= 0 ? std::nullopt : page_faults_in({text.data(), static_cast<std::size_t>(got)});
}

std::optional<PageFaults> page_faults_in(std::string_view stat) {
    // The second field is the thread's name in brackets, and may hold blanks and brackets itself; from the last one on there are numbers.
    constexpr int minor_field = 10, major_field = 12;
    const auto bracket = stat.rfind(')');
    if (bracket == std::string_view::npos) return std::nullopt;
    PageFaults faults;
    auto rest = stat.substr(bracket + 1);
    for (int field = 3; field <= major_field; ++field) {
        const auto begin = rest.find_first_not_of(' ');
        if (begin == std::string_view::npos) return std::nullopt;
        rest.remove_prefix(begin);
        const auto word = rest.substr(0, rest.find(' '));
        if (field == minor_field || field == major_field) {
            auto& number = field == minor_field ? faults.minor : faults.major;
            const auto read = std::from_chars(word.data(), word.data() + word.size(), number);
            if (read.ec != std::errc{} || read.ptr != word.data() + word.size()) return std::nullopt;
        }
        rest.remove_prefix(word.size());
    }
    return faults;
}

}  // namespace taktwerk
