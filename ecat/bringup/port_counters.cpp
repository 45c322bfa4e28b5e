#include "ecat/bringup/port_counters.hpp"

#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

namespace {

constexpr std::uint16_t counter_bytes = reg::lost_links - reg::rx_errors + ports_per_slave;

}  // namespace

Script<std::optional<SlaveCounters>> read_port_counters(DatagramPort& port, std::uint16_t station) {
    const Reply reply = co_await port.fprd(station, reg::rx_errors, counter_bytes);
    if (!reply.ok()) co_return std::nullopt;
    const auto byte_at = [&](std::size_t at) { return std::to_integer<std::uint8_t>(reply.data[at]); };
    SlaveCounters read;
    for (unsigned p = 0; p < ports_per_slave; ++p)
        read.ports[p] = {byte_at(2 * p), byte_at(2 * p + 1), byte_at(reg::forwarded_rx_errors - reg::rx_errors + p),
                         byte_at(reg::lost_links - reg::rx_errors + p)};
    read.processing_unit_errors = byte_at(reg::processing_unit_errors - reg::rx_errors);
    read.pdi_errors = byte_at(reg::pdi_errors - reg::rx_errors);
    co_return read;
}

Script<void> clear_port_counters(DatagramPort& port, std::uint16_t station) {
    // Writing one of a block clears the block.
    for (const auto block : {reg::rx_errors, reg::forwarded_rx_errors, reg::lost_links})
        co_await port.fpwr(station, block, std::uint8_t{0});
}

}  // namespace taktwerk::ecat
