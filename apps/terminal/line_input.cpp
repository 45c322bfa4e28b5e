#include "apps/terminal/line_input.hpp"

#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <utility>

namespace taktwerk::apps {

LineInput::LineInput(int descriptor) : descriptor_(descriptor) {
    // In the background of a terminal a read would stop the whole process.
    std::signal(SIGTTIN, SIG_IGN);
}

std::optional<std::string> LineInput::next() {
    constexpr std::size_t longest_line = 4096;
    for (;;) {
        if (const auto end = waiting_.find('\n'); end != std::string::npos) {
            std::string line = waiting_.substr(0, end);
            waiting_.erase(0, end + 1);
            return line;
        }
        if (descriptor_ < 0) {
            if (waiting_.empty()) return std::nullopt;
            return std::exchange(waiting_, std::string{});  // the last line had no end
        }
        pollfd ready{descriptor_, POLLIN, 0};
        if (::poll(&ready, 1, 0) <= 0) return std::nullopt;
        char bytes[512];
        const auto count = ::read(descriptor_, bytes, sizeof bytes);
        if (count <= 0 || waiting_.size() > longest_line) descriptor_ = -1;
        else waiting_.append(bytes, static_cast<std::size_t>(count));
    }
}

}  // namespace taktwerk::apps
