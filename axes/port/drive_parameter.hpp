#pragma once
// What a drive's manual says of one parameter: an object of its dictionary, or a register of a drive without one. Rows of
// config/drives/*.objects.yaml (and of `objects:` in the drive file itself). The bus' own view of an object is ecat::ObjectEntry.
// Plain data; read at start, never in the cycle.

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "axes/port/drive_port.hpp"

namespace taktwerk::axes {

/// When a new value counts.
enum class ParameterEffect : std::uint8_t {
    at_once,        ///< SV33-E "immediately", SV-DA200 P4.25
    at_standstill,  ///< SV33-E "effective when stopped"
    when_enabled,   ///< at the next enabling
    after_restart,  ///< of the control supply (SV33-E A.426, SV-DA200 P0.03, XP200 Pr004): what it has stored by then
    after_saving,   ///< and restarting: without an order to save, nothing written ever counts (SE-808X 6, TSVM's starred ones)
};

/// What is known of the value that a drive leaves the factory with.
enum class FactoryValue : std::uint8_t {
    unknown,  ///< the manual prints none; `value` is what the simulated drive begins with
    assumed,  ///< ours: the manual leaves it open or contradicts itself, `assumed` of the drive file says which
    stated,   ///< the manual's, in `section`
};

/// When the drive takes a write.
enum class ParameterChange : std::uint8_t {
    any_time,
    disabled,  ///< with the motor stopped or not enabled
    never,     ///< read-only
};

/// Who can reach it.
enum class ParameterReach : std::uint8_t {
    bus,         ///< by its address
    maker_tool,  ///< panel or PC tool alone: the manual prints no address (TSVM 6.1, column "-")
};

struct DriveParameter {
    ParameterAddress address;  ///< of the first axis; 0 where only the maker's tool reaches it
    ParameterReach reach = ParameterReach::bus;
    std::string parameter;   ///< as the manual calls it: "P05.10", "PA17", "Pr098"; empty: an object of the standard, by its number
    std::string name;        ///< in English
    std::string chinese;     ///< as printed; empty: not printed
    std::uint8_t bits = 16;  ///< width on the wire; 0: text
    bool is_signed = false;
    std::int64_t value = 0;  ///< factory value, raw, as far as `factory` says that there is one
    FactoryValue factory = FactoryValue::unknown;
    std::optional<std::int64_t> minimum{}, maximum{};
    std::string unit;     ///< of raw * scale, as people read it: "ms", "%", "rpm"
    double scale = 1;     ///< one raw count in `unit` ("0.1 %": scale 0.1, unit %)
    std::string meaning;  ///< of the values, where they are a choice: "0 nothing, 1 parameters, 3 both"
    ParameterEffect effect = ParameterEffect::at_once;
    ParameterChange change = ParameterChange::any_time;
    bool action = false;  ///< writing it does something (store, restore, clear turns): never part of a saved set
    std::string section;  ///< of the manual

    /// What is written now does not count before a restart.
    [[nodiscard]] bool waits_for_restart() const noexcept {
        return effect == ParameterEffect::after_restart || effect == ParameterEffect::after_saving;
    }
    /// It is as the manual says that the drive left the factory. Never of a value that is assumed or unknown.
    [[nodiscard]] bool is_stated_factory(std::int64_t raw) const noexcept { return factory == FactoryValue::stated && raw == value; }
};

}  // namespace taktwerk::axes
