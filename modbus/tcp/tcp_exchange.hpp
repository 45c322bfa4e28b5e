#pragma once
// A device at the other end of a TCP connection, by libmodbus. The socket is connected here: libmodbus takes every failure to connect for a
// refusal, and what is unreachable wants another remedy than what is switched off.

#include <memory>

#include "modbus/tcp/exchange.hpp"

namespace taktwerk::modbus::tcp {

/// The answer's transaction, function and length are compared with the request; its unit and protocol number are not (libmodbus 3.1.6 looks
/// at neither over TCP).
class TcpExchange final : public Exchange {
public:
    /// Only what `device` says of address, port, unit and timeout.
    explicit TcpExchange(const DeviceConfig& device);
    ~TcpExchange() override;

    [[nodiscard]] bool connected() const override { return connected_; }
    [[nodiscard]] Fault connect() override;
    void close() override;
    [[nodiscard]] Fault read(Table table, std::uint16_t address, std::span<std::uint16_t> values) override;
    [[nodiscard]] Fault write(Table table, std::uint16_t address, std::span<const std::uint16_t> values) override;

private:
    struct Context;
    std::unique_ptr<Context> context_;
    DeviceConfig device_;
    bool connected_ = false;
};

/// Whether a host is an address that needs no looking up.
[[nodiscard]] bool is_address(const std::string& host);

}  // namespace taktwerk::modbus::tcp
