#include "apps/machine/crash_line.hpp"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <string_view>

#include "runtime/tasks/code_at_work.hpp"

namespace taktwerk::apps {

namespace {

/// A line put together without anything that is not async-signal-safe (signal-safety(7)).
class Line {
public:
    Line& operator<<(std::string_view text) noexcept {
        for (const char c : text)
            if (length_ < sizeof text_) text_[length_++] = c;
        return *this;
    }
    void write() const noexcept {
        pollfd ready{STDERR_FILENO, POLLOUT, 0};
        if (::poll(&ready, 1, 100) <= 0) return;  // a terminal that takes nothing must not keep a crashed process
        [[maybe_unused]] const auto put = ::write(STDERR_FILENO, text_, length_);
    }

private:
    char text_[512];
    std::size_t length_ = 0;
};

std::string_view name_of(int signal) noexcept {
    switch (signal) {
        case SIGSEGV: return "SIGSEGV: memory that is not there, e.g. a null pointer or a recursion without end";
        case SIGBUS: return "SIGBUS: memory that cannot be read or written";
        case SIGFPE: return "SIGFPE: a whole number divided by zero, or an overflow of such a division";
        case SIGILL: return "SIGILL: an instruction that this CPU does not know";
        case SIGABRT: return "SIGABRT: abort(), e.g. a failed assertion or an exception nobody catches";
        default: return "a signal";
    }
}

[[maybe_unused]] void crashed(int signal) {  // a sanitizer keeps its own handlers
    const int kept = errno;
    const auto code = runtime::code_at_work();
    Line line;
    line << "taktwerk crashed";
    if (code.program != nullptr) line << " in '" << code.part << "' of program '" << code.program << "'";
    line << ": " << name_of(signal) << ". No frame leaves any more: the drives stop by their own watchdogs.\n"
         << (code.program != nullptr ? "  -> Mend that program; a core file, where the system keeps them, shows the line.\n"
                                     : "  -> This is a defect of Taktwerk: report it, with the core file where the system keeps them.\n");
    line.write();
    errno = kept;
    ::raise(signal);  // as it always did: the handler has been taken away by SA_RESETHAND
}

}  // namespace

void say_crashes() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
        struct sigaction action {};
        action.sa_handler = crashed;
        action.sa_flags = static_cast<int>(SA_ONSTACK | SA_RESETHAND | SA_NODEFER);
        sigemptyset(&action.sa_mask);
        sigaction(signal, &action, nullptr);
    }
#endif
}

}  // namespace taktwerk::apps
