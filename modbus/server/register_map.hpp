#pragma once
// Which of the offered registers a request means.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "modbus/server/served_register.hpp"

namespace taktwerk::modbus::server {

/// Built once; then only read, by any thread.
class RegisterMap {
public:
    /// Of registers that overlap() each other it finds one; whoever reads a configuration refuses them before.
    explicit RegisterMap(std::vector<ServedRegister> registers);

    [[nodiscard]] const std::vector<ServedRegister>& registers() const noexcept { return registers_; }

    struct Place {
        std::uint16_t address = 0;
        std::uint16_t index = 0;  ///< of registers()
    };
    /// What lies in `count` addresses from `address`, by address. Nothing: one of them is offered by nobody, or a number of two registers would be
    /// cut: its halves could come from two cycles. Real-time safe.
    [[nodiscard]] std::optional<std::span<const Place>> find(Table table, std::uint16_t address, std::uint16_t count) const noexcept;

private:
    std::vector<ServedRegister> registers_;
    std::array<std::vector<Place>, 4> places_;  // by table, sorted by address
};

}  // namespace taktwerk::modbus::server
