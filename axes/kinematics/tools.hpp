#pragma once
// What an arm carries, by number. PLCopen Part 4 v2.0: tool 0 is the flange, payload 0 nothing; neither can be written. Plain data.

#include <array>
#include <cstddef>

#include "axes/pose.hpp"

namespace taktwerk::axes {

/// A rigid body, in the frame of the tool's point (TCP). kg, kg m2, places in the machine's unit of length. No set-point depends on it: what loads a drive
/// may carry is the drive's feed-forward's matter. Numbers stay as they were written, so that who reads them finds them.
struct RigidBody {
    double mass = 0;
    SixNumbers centre{};              ///< centre of gravity, and the directions of the principal axes
    std::array<double, 3> inertia{};  ///< about the principal axes through the centre

    friend bool operator==(const RigidBody&, const RigidBody&) = default;
};

struct Tool {
    SixNumbers frame{};  ///< the tool's point and directions, seen from the flange
    RigidBody body{};

    friend bool operator==(const Tool&, const Tool&) = default;
};

inline constexpr std::size_t tool_numbers = 32;     ///< 0 .. 31
inline constexpr std::size_t payload_numbers = 32;  ///< 0 .. 31

/// Entries by number. Number 0 stands as it is; what is not defined is not there.
template <class Entry, std::size_t numbers>
class Numbered {
public:
    /// nullptr: no such number, or nothing defined under it.
    [[nodiscard]] const Entry* find(std::size_t number) const noexcept {
        return number < numbers && defined_[number] ? &entries_[number] : nullptr;
    }
    /// False, and nothing changes: number 0, or beyond the last.
    [[nodiscard]] bool define(std::size_t number, const Entry& entry) noexcept {
        if (number == 0 || number >= numbers) return false;
        entries_[number] = entry;
        return defined_[number] = true;
    }

private:
    std::array<Entry, numbers> entries_{};
    std::array<bool, numbers> defined_{true};
};
using Tools = Numbered<Tool, tool_numbers>;
using Payloads = Numbered<RigidBody, payload_numbers>;

}  // namespace taktwerk::axes
