#include "ecat/bringup/slave_objects.hpp"

#include <algorithm>

namespace taktwerk::ecat {

void remember_abort(BusSlave& slave, const Error& error) {
    if (error.code == "sdo.abort") slave.last_abort = error.what;
}

bool is_absent(const Error& error) noexcept {
    const auto code = abort_code(error);
    return code == sdo_abort::no_object || code == sdo_abort::no_subindex;
}

bool is_read_only(const Error& error) noexcept {
    const auto code = abort_code(error);
    return code == sdo_abort::unsupported_access || code == sdo_abort::read_only;
}

Script<Result<void>> write_number(Bus& bus, BusSlave& slave, std::uint16_t index, std::uint8_t sub, std::uint32_t value,
                                  std::size_t bytes) {
    std::vector<std::byte> data(bytes);
    for (std::size_t i = 0; i < bytes; ++i) data[i] = static_cast<std::byte>((value >> (8 * i)) & 0xFFu);
    bus.note(slave, "writing " + object_text(index, sub));
    const Result<void> written = co_await sdo_download(bus.port, slave.mailbox, index, sub, std::move(data));
    if (!written) remember_abort(slave, written.error());
    co_return written;
}

Script<Result<std::uint32_t>> read_number(Bus& bus, BusSlave& slave, std::uint16_t index, std::uint8_t sub) {
    const Result<std::vector<std::byte>> data = co_await sdo_upload(bus.port, slave.mailbox, index, sub);
    if (!data) {
        if (!is_absent(data.error())) remember_abort(slave, data.error());
        co_return data.error();
    }
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < std::min<std::size_t>(4, data->size()); ++i) value |= static_cast<std::uint32_t>((*data)[i]) << (8 * i);
    co_return value;
}

}  // namespace taktwerk::ecat
