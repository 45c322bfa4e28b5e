#pragma once
// What a row of the signal ring holds: names and units for people, and where in the row each value stands. Plain data; fixed when the
// machine is built. A recording carries the same list with it.

#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace taktwerk::runtime {

/// How a value is to be shown: a curve, a 0/1 lane, a lane of named states, whole numbers, bits of a word.
enum class SignalKind : std::uint8_t { real, bit, state, whole, word };
enum class SignalGroup : std::uint8_t { axis, input, output, variable, machine, bus, task, group };

/// Where a value stands in a row of 64-bit words. The first bit is the lowest one of its word.
struct SignalCell {
    enum class Coding : std::uint8_t { real, natural, integer };  ///< IEEE double (64 bits); without a sign; two's complement
    std::uint16_t word = 0;
    std::uint8_t first_bit = 0, bits = 64;
    Coding coding = Coding::real;
    double per = 1;  ///< > 0: the number in the word counts parts of the signal's unit, so many to one of it

    /// Real-time safe.
    [[nodiscard]] double value_of(std::uint64_t whole) const noexcept {
        if (coding == Coding::real) return std::bit_cast<double>(whole);
        const auto left = static_cast<unsigned>(64 - bits - first_bit), unused = static_cast<unsigned>(64 - bits);
        if (coding == Coding::integer) return static_cast<double>(static_cast<std::int64_t>(whole << left) >> unused) / per;
        return static_cast<double>((whole << left) >> unused) / per;
    }
    friend bool operator==(const SignalCell&, const SignalCell&) = default;
};

struct RecordedSignal {
    std::string name, unit;  ///< "x.set_position", "mm"; the unit is empty where there is none
    SignalKind kind = SignalKind::real;
    SignalGroup group = SignalGroup::machine;
    std::string of;                ///< axis, point, program, task; empty: the machine
    std::string english, chinese;  ///< what it is
    SignalCell cell;
    bool in_trace = false;                                 ///< a column of `run --trace`
    std::vector<std::pair<int, std::string>> states = {};  ///< of kind `state`: each number's word
    friend bool operator==(const RecordedSignal&, const RecordedSignal&) = default;
};

}  // namespace taktwerk::runtime
