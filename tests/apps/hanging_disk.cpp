// Preloaded into a process: opening a file whose path ends in TAKTWERK_TEST_HANGS never comes back, as on a disk that takes nothing.
#include <cstdarg>
#include <cstdlib>
#include <string_view>

#include <dlfcn.h>
#include <fcntl.h>
#include <time.h>

namespace {

void hang_at(const char* path) {
    const char* end = ::getenv("TAKTWERK_TEST_HANGS");
    if (end == nullptr || path == nullptr || !std::string_view(path).ends_with(end)) return;
    for (;;) {
        const timespec long_time{3600, 0};
        ::nanosleep(&long_time, nullptr);
    }
}

}  // namespace

extern "C" int open(const char* path, int flags, ...) {
    hang_at(path);
    mode_t mode = 0;
    if ((flags & O_CREAT) != 0) {
        va_list more;
        va_start(more, flags);
        mode = va_arg(more, mode_t);
        va_end(more);
    }
    static const auto next = reinterpret_cast<int (*)(const char*, int, ...)>(::dlsym(RTLD_NEXT, "open"));
    return next(path, flags, mode);
}
/// On 64 bit the same.
extern "C" int open64(const char*, int, ...) __attribute__((alias("open")));
