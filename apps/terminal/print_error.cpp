#include "apps/terminal/print_error.hpp"

#include <unistd.h>

#include <cstdio>

#include <fmt/format.h>

namespace taktwerk::apps {
namespace {

bool colours(int fd) { return ::isatty(fd) != 0; }

void print(const char* colour, const char* word, const Error& error) {
    const bool tty = colours(STDERR_FILENO);
    fmt::print(stderr, "{}{}{}: {}{}\n", tty ? colour : "", word, tty ? "\033[0m" : "", error.subject.empty() ? "" : error.subject + ": ",
               error.what);
    if (!error.remedy.empty()) fmt::print(stderr, "  -> {}\n", error.remedy);
}

}  // namespace

void print_error(const Error& error) { print("\033[1;31m", "error", error); }
void print_warning(const Error& warning) { print("\033[1;33m", "warning", warning); }
void print_errors(const std::vector<Error>& errors) {
    for (const auto& error : errors) print_error(error);
    if (errors.size() > 1) fmt::print(stderr, "{} problems; nothing was started\n", errors.size());
}

}  // namespace taktwerk::apps
