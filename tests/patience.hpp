#pragma once
// A bound for a test's loop that waits for something: a test whose machine never gets there fails; it does not hang its binary and take
// the others with it.

#include <gtest/gtest.h>

#include <cstdint>

namespace taktwerk {

/// for (Patience patience; patience.lasts(view.position < 60);) rig.step();
/// Counts turns of the loop (cycles of a rig), never the wall clock.
class Patience {
public:
    /// The default is twenty seconds of cycles of 1 ms; no wait of a rig is as long.
    explicit Patience(std::int64_t turns = 20'000) : turns_{turns} {}
    /// For threads that wait for each other with a yield a turn: half a minute at least, however busy the computer is.
    [[nodiscard]] static Patience of_threads() { return Patience{100'000'000}; }

    /// `waiting` itself while there are turns left; then false, and the test has failed at the caller's line.
    /// (Not std::source_location: libstdc++ 12 has it for g++ only, and clang++ 14 compiles the tests, too.)
    [[nodiscard]] bool lasts(bool waiting, const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
        if (!waiting) return false;
        if (turns_ > 0) {
            --turns_;
            return true;
        }
        if (!said_) ADD_FAILURE_AT(file, line) << "this wait has no end: the condition still held after the last turn";
        said_ = true;
        return false;
    }

private:
    std::int64_t turns_;
    bool said_ = false;
};

}  // namespace taktwerk
