#pragma once
// What a program says of the parameters and variables that it declares. FROZEN SHAPE (extend additively); the ABI hash of programs/api/abi.hpp
// guards it.

#include <cstdint>
#include <string_view>

namespace taktwerk {

/// What a parameter may be. `whole`: a count, a number of a recipe; 1.5 is refused in the machine file and to the operator, and get() gives
/// the number exactly.
enum class ParameterKind : std::uint8_t { real, whole };

/// All in `unit`. minimum <= value <= maximum, otherwise the machine does not start. The machine file may set another value.
struct ParameterSpec {
    double value = 0;                 ///< default
    double minimum = 0, maximum = 0;  ///< inclusive; the runtime refuses anything else, also from the operator
    std::string_view unit{};
    std::string_view doc{};
    ParameterKind kind = ParameterKind::real;
};

/// What a person may write, in `unit`: minimum <= value <= maximum, whole where the variable is. The variable's own first value is its default
/// and must lie inside, else the machine does not start.
struct OperatorValueSpec {
    double minimum = 0, maximum = 0;  ///< inclusive; not looked at for switches and buttons, which are FALSE or TRUE
    std::string_view unit{};
    std::string_view doc{};
    std::string_view task{};  ///< whose scans it is for, and who alone reads or writes it; needed where the program has several tasks
};

/// Types of monitored variables.
enum class VariableType : std::uint8_t { boolean, int32, int64, uint16, uint32, real, duration };

/// How a person changes a variable.
enum class OperatorValueKind : std::uint8_t { value, toggle, button };

/// Which starts a variable outlives (IEC 61131-3 ed. 3, 6.5.6; cold and origin as in CODESYS). A warm start is the usual one, after power was
/// off too; `taktwerk run --start cold` begins anew but for what is persistent, `--start origin` with nothing at all.
enum class RetainKind : std::uint8_t {
    retain,      ///< warm
    persistent,  ///< warm and cold: settings, totals
};

}  // namespace taktwerk
