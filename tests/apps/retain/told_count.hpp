#pragma once
// What a program has counted, for who looks from outside: a page of a file in memory, which stays as it is when the process is killed.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace taktwerk::apps {

/// The file's name is in the environment of the process; without it the program tells nobody.
inline constexpr const char* told_count_variable = "TAKTWERK_TEST_TOLD_COUNT";

/// Variables that are all counted in the same scan: one that differs from the others is torn.
inline constexpr std::size_t counted_together = 32;

struct ToldCount {
    static constexpr std::size_t remembered = 1 << 16;
    std::atomic<std::uint64_t> starts;                              ///< times that start() was called
    std::array<std::atomic<std::int64_t>, counted_together> found;  ///< what stood in the variables then
    std::atomic<std::int64_t> found_block;                          ///< and in a counter (CTU.CV) that counts with them
    std::atomic<std::int64_t> count;                                ///< now
    std::array<std::atomic<std::int64_t>, remembered> since;        ///< [count % remembered]: machine time of that scan, ns
};
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

}  // namespace taktwerk::apps
