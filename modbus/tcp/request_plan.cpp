#include "modbus/tcp/request_plan.hpp"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

namespace taktwerk::modbus::tcp {

namespace {

unsigned most_of(bool write, Table table) {
    if (is_bits(table)) return write ? most_bits_written : most_bits_read;
    return write ? most_registers_written : most_registers_read;
}

unsigned end_of(const Channel& channel) { return channel.address + 0u + addresses_of(channel.type); }

/// Whether `channel` fits behind what the request already has; it does not begin before it.
bool joins(const Request& request, const Channel& channel, unsigned gap) {
    const unsigned end = request.address + 0u + request.count, whole = std::max(end, end_of(channel)) - request.address;
    return request.table == channel.table && channel.address <= end + (request.write ? 0 : gap) &&
           whole <= most_of(request.write, request.table);
}

}  // namespace

std::string text_of(const Request& request) {
    const char* table = request.table == Table::coil             ? "coils"
                        : request.table == Table::discrete_input ? "discrete inputs"
                        : request.table == Table::holding        ? "holding registers"
                                                                 : "input registers";
    const unsigned last = request.address + 0u + request.count - 1;
    auto out = fmt::format("function {}, {} {}", function_of(request), table, request.address);
    if (last != request.address) out += fmt::format(" to {}", last);
    return out;
}

int function_of(const Request& request) noexcept {
    switch (request.table) {
        case Table::coil: return !request.write ? 1 : request.count == 1 ? 5 : 15;
        case Table::discrete_input: return 2;
        case Table::holding: return !request.write ? 3 : request.count == 1 ? 6 : 16;
        case Table::input: break;
    }
    return 4;
}

std::vector<Request> plan_requests(const DeviceConfig& device) {
    const auto& channels = device.channels;
    const auto written = [&](std::size_t i) { return channels[i].use == Channel::Use::written; };
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < channels.size(); ++i)
        if (channels[i].use != Channel::Use::none) order.push_back(i);
    std::ranges::stable_sort(order, {}, [&](std::size_t i) {
        return std::tuple{!written(i), channels[i].table, channels[i].address, addresses_of(channels[i].type)};
    });
    std::vector<Request> plan;
    for (const auto i : order) {
        const auto& channel = channels[i];
        if (plan.empty() || plan.back().write != written(i) || !joins(plan.back(), channel, device.gap))
            plan.push_back({written(i), channel.table, channel.address, 0, {}});
        auto& request = plan.back();
        request.count = static_cast<std::uint16_t>(std::max(request.address + 0u + request.count, end_of(channel)) - request.address);
        request.channels.push_back(i);
    }
    return plan;
}

}  // namespace taktwerk::modbus::tcp
