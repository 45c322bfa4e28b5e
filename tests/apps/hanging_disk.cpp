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

using Open = int (*)(const char*, int, ...);

int open_really(const char* name, const char* path, int flags, mode_t mode) {
    const auto next = reinterpret_cast<Open>(::dlsym(RTLD_NEXT, name));
    return next(path, flags, mode);
}

mode_t mode_of(int flags, va_list& more) { return (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : 0; }

}  // namespace

extern "C" int open(const char* path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const mode_t mode = mode_of(flags, more);
    va_end(more);
    hang_at(path);
    return open_really("open", path, flags, mode);
}

extern "C" int open64(const char* path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const mode_t mode = mode_of(flags, more);
    va_end(more);
    hang_at(path);
    return open_really("open64", path, flags, mode);
}
