#include "core/guard/allocation_guard.hpp"

#include <execinfo.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <new>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TAKTWERK_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define TAKTWERK_SANITIZED 1
#endif
#endif

namespace taktwerk {
namespace {

// initial-exec: the first access from within malloc must not call malloc.
#define TAKTWERK_PLAIN_TLS constinit thread_local __attribute__((tls_model("initial-exec")))
TAKTWERK_PLAIN_TLS int scopes_here = 0;
TAKTWERK_PLAIN_TLS bool abort_here = false;
TAKTWERK_PLAIN_TLS bool noting_here = false;  // backtrace() may allocate
TAKTWERK_PLAIN_TLS HeapUse use_here{};

void note(std::size_t size, bool is_free) noexcept {
    if (scopes_here == 0 || noting_here) return;
    noting_here = true;
    const int saved = errno;
    if (use_here.backtrace_depth == 0) {  // the first since the innermost scope began
        use_here.first_size = size;
        use_here.backtrace_depth =
            static_cast<std::size_t>(::backtrace(use_here.backtrace.data(), static_cast<int>(use_here.backtrace.size())));
    }
    ++(is_free ? use_here.frees : use_here.allocations);
    if (abort_here) {
        constexpr char message[] = "heap used within a NoAllocationScope:\n";
        (void)!::write(STDERR_FILENO, message, sizeof message - 1);
        ::backtrace_symbols_fd(use_here.backtrace.data(), static_cast<int>(use_here.backtrace_depth), STDERR_FILENO);
        std::abort();
    }
    errno = saved;
    noting_here = false;
}

}  // namespace

NoAllocationScope::NoAllocationScope(On on) noexcept : before_(use_here), abort_before_(abort_here) {
    void* warm_up[2];
    (void)::backtrace(warm_up, 2);  // its first call loads a library
    if (scopes_here == 0) before_ = use_here = {};
    use_here.backtrace_depth = 0;
    abort_here = on == On::allocation_abort;
    ++scopes_here;
}

NoAllocationScope::~NoAllocationScope() {
    --scopes_here;
    abort_here = abort_before_;
}

HeapUse NoAllocationScope::used() const noexcept {
    HeapUse use = use_here;
    use.allocations -= before_.allocations;
    use.frees -= before_.frees;
    return use;
}

std::string HeapUse::text() const {
    if (total() == 0) return "heap not used";
    std::string out = fmt::format("{} allocations and {} frees, the first of {} bytes", allocations, frees, first_size);
    if (char** lines = ::backtrace_symbols(backtrace.data(), static_cast<int>(backtrace_depth)); lines != nullptr) {
        for (std::size_t i = 0; i < backtrace_depth; ++i) out += fmt::format("\n    {}", lines[i]);
        std::free(lines);
    }
    return out;
}

}  // namespace taktwerk

#if defined(TAKTWERK_SANITIZED)

// The sanitizers' malloc stays; operator new goes through here. All forms of new and delete end in these (replaceable
// functions, [new.delete]); the nothrow and array forms of libstdc++ call them.
void* operator new(std::size_t size) {
    taktwerk::note(size, false);
    if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
    throw std::bad_alloc{};
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    taktwerk::note(size, false);
    const auto a = static_cast<std::size_t>(alignment);
    if (void* memory = std::aligned_alloc(a, (size + a - 1) / a * a)) return memory;
    throw std::bad_alloc{};
}
void* operator new[](std::size_t size) { return operator new(size); }
void* operator new[](std::size_t size, std::align_val_t alignment) { return operator new(size, alignment); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    taktwerk::note(size, false);
    return std::malloc(size == 0 ? 1 : size);
}
void* operator new[](std::size_t size, const std::nothrow_t& tag) noexcept { return operator new(size, tag); }
void operator delete(void* memory) noexcept {
    if (memory != nullptr) taktwerk::note(0, true);
    std::free(memory);
}
void operator delete[](void* memory) noexcept { operator delete(memory); }
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }
void operator delete[](void* memory, std::size_t) noexcept { operator delete(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { operator delete(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { operator delete(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { operator delete(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { operator delete(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { operator delete(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { operator delete(memory); }

#else

// glibc's own names for its allocator; operator new ends in malloc.
extern "C" {
void* __libc_malloc(std::size_t size);                           // NOLINT(bugprone-reserved-identifier,readability-identifier-naming)
void* __libc_calloc(std::size_t count, std::size_t size);        // NOLINT(bugprone-reserved-identifier,readability-identifier-naming)
void* __libc_realloc(void* memory, std::size_t size);            // NOLINT(bugprone-reserved-identifier,readability-identifier-naming)
void* __libc_memalign(std::size_t alignment, std::size_t size);  // NOLINT(bugprone-reserved-identifier,readability-identifier-naming)
void __libc_free(void* memory);                                  // NOLINT(bugprone-reserved-identifier,readability-identifier-naming)

void* malloc(std::size_t size) noexcept {
    taktwerk::note(size, false);
    return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
    taktwerk::note(count * size, false);
    return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
    taktwerk::note(size, false);
    return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
    taktwerk::note(size, false);
    return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept { return memalign(alignment, size); }
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
    if (alignment < sizeof(void*) || (alignment & (alignment - 1)) != 0) return EINVAL;
    void* got = memalign(alignment, size);
    if (got == nullptr) return ENOMEM;
    *memory = got;
    return 0;
}
void free(void* memory) noexcept {
    if (memory != nullptr) taktwerk::note(0, true);
    __libc_free(memory);
}
}

#endif
