#pragma once
// A named point of the machine: where it comes from and what its number means. Plain data.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "axes/words/types.hpp"
#include "core/point_line.hpp"
#include "core/process_image.hpp"
#include "core/time.hpp"

namespace taktwerk::runtime {

enum class IoDirection : std::uint8_t { input, output };

/// What a terminal says of one of its inputs beside the value: an object of the same process data that is not 0.
struct PointStatus {
    enum class Kind : std::uint8_t { error, underrange, overrange } kind = Kind::error;
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
};

/// Between which values an input is right, in its unit; outside it raises an alarm.
struct PointLimits {
    double low = 0, high = 0;
};

/// No object at all: whether a group of hot connect is there.
struct PresenceInput {
    std::string group;
    axes::Presence shows = axes::Presence::present;  ///< TRUE while the group is this
};

/// A named point that programs, commands and the HMI use.
struct IoPoint {
    std::string name;
    IoDirection direction = IoDirection::input;
    std::string slave;
    std::uint16_t index = 0;  ///< mapped object
    std::uint8_t sub = 0;
    /// Of a Modbus device, which is polled beside the cycle: how wide its number is. Then `slave` is the device, `index` the place of the
    /// channel in it.
    std::optional<Signal> beside{};
    std::optional<PresenceInput> presence{};  ///< then there is no slave
    bool inverted = false;                    ///< 1-bit points: TRUE when the terminal says 0
    std::string unit{};                       ///< of its value; empty: the number itself
    PointLine line{};                         ///< from the number of the object to that unit; the bits that the bus shows narrow its range
    std::optional<PointLimits> limits{};      ///< inputs
    Duration filter{};                        ///< inputs: time constant of a first-order filter on the value; 0 = none
    std::vector<PointStatus> status{};        ///< inputs
    /// Outputs: from the bus' first frames on, while no program drives it, and at the end. Not when the master is gone or the
    /// cable is cut: then the terminal's own watchdog sets its outputs to zero, whatever stands here.
    std::int64_t safe_value = 0;
    std::optional<std::int64_t> simulated{};  ///< inputs: value the simulated terminal starts with
};

}  // namespace taktwerk::runtime
