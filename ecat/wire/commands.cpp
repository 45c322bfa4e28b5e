#include "ecat/wire/commands.hpp"

#include <array>

namespace taktwerk::ecat {

std::string_view name(Command command) noexcept {
    static constexpr std::array<std::string_view, 15> names{"NOP", "APRD", "APWR", "APRW", "FPRD", "FPWR", "FPRW", "BRD",
                                                            "BWR", "BRW",  "LRD",  "LWR",  "LRW",  "ARMW", "FRMW"};
    const auto number = static_cast<std::size_t>(command);
    return number < names.size() ? names[number] : std::string_view{"unknown"};
}

}  // namespace taktwerk::ecat
