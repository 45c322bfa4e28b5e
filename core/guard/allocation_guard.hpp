#pragma once
// Proves that a stretch of code allocates and frees nothing. Linking this library replaces malloc and its family (in builds with
// sanitizers, which have their own malloc, only operator new and delete): for tests, not for what ships.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace taktwerk {

/// What the calling thread did with the heap inside its NoAllocationScopes.
struct HeapUse {
    std::uint64_t allocations = 0;
    std::uint64_t frees = 0;
    std::size_t first_size = 0;         ///< bytes of the first allocation; 0 when the first was a free
    std::array<void*, 24> backtrace{};  ///< of the first use
    std::size_t backtrace_depth = 0;

    [[nodiscard]] std::uint64_t total() const noexcept { return allocations + frees; }
    /// For a test's message. Allocates: call it outside of the scope.
    [[nodiscard]] std::string text() const;
};

/// While one lives, each use of the heap by the thread that made it is counted. Scopes nest: each sees what happened since it began.
class NoAllocationScope {
public:
    enum class On : std::uint8_t {
        allocation_count,  ///< carry on and let used() tell
        allocation_abort,  ///< end the process with the backtrace on stderr, where a debugger finds the culprit
    };

    explicit NoAllocationScope(On on = On::allocation_count) noexcept;
    ~NoAllocationScope();
    NoAllocationScope(const NoAllocationScope&) = delete;
    NoAllocationScope& operator=(const NoAllocationScope&) = delete;

    /// Since this scope began. On the scope's own thread.
    [[nodiscard]] HeapUse used() const noexcept;

private:
    HeapUse before_;
    bool abort_before_;
};

}  // namespace taktwerk
