#include "ecat/wire/sdo.hpp"

#include <algorithm>

#include "core/bytes.hpp"

namespace taktwerk::ecat {

namespace {

// Command byte. Initiate: b0 size given, b1 expedited, b3..2 unused bytes, b4 complete access, b7..5 command.
// Segment: b0 last, b3..1 unused of 7, b4 toggle, b7..5 command.
constexpr unsigned size_given = 0x01, expedited_bit = 0x02, complete_bit = 0x10, toggle_bit = 0x10, last_bit = 0x01;
enum RequestCommand : unsigned { download_segment = 0, download = 1, upload = 2, upload_segment = 3, abort_transfer = 4 };
enum ResponseCommand : unsigned { upload_segment_done = 0, download_segment_done = 1, upload_done = 2, download_done = 3 };

void store_head(std::span<std::byte> out, CoeService service, unsigned command, unsigned flags) noexcept {
    store_le<std::uint16_t>(out, 0, static_cast<std::uint16_t>(static_cast<unsigned>(service) << 12));
    out[2] = static_cast<std::byte>((command << 5) | flags);
}

std::size_t encode_initiate(std::span<std::byte> out, CoeService service, unsigned command, unsigned flags, std::uint16_t index,
                            std::uint8_t sub, std::uint32_t word) noexcept {
    if (out.size() < sdo_initiate_size) return 0;
    store_head(out, service, command, flags);
    store_le<std::uint16_t>(out, 3, index);
    out[5] = static_cast<std::byte>(sub);
    store_le<std::uint32_t>(out, 6, word);
    return sdo_initiate_size;
}

std::size_t encode_with_data(std::span<std::byte> out, CoeService service, unsigned command, std::uint16_t index, std::uint8_t sub,
                             std::span<const std::byte> data, bool complete_access) noexcept {
    const unsigned access = complete_access ? complete_bit : 0u;
    if (!data.empty() && data.size() <= 4) {
        std::uint32_t word = 0;
        for (std::size_t i = 0; i < data.size(); ++i) word |= static_cast<std::uint32_t>(data[i]) << (8 * i);
        const unsigned unused = static_cast<unsigned>(4 - data.size()) << 2;
        return encode_initiate(out, service, command, size_given | expedited_bit | unused | access, index, sub, word);
    }
    const auto head = encode_initiate(out, service, command, size_given | access, index, sub, static_cast<std::uint32_t>(data.size()));
    if (head == 0) return 0;
    const std::size_t part = std::min(data.size(), out.size() - head);
    std::copy_n(data.begin(), part, out.begin() + static_cast<std::ptrdiff_t>(head));
    return head + part;
}

std::size_t encode_segment(std::span<std::byte> out, CoeService service, unsigned command, bool toggle, bool last,
                           std::span<const std::byte> data) noexcept {
    const std::size_t padded = std::max(data.size(), sdo_segment_minimum);
    if (out.size() < sdo_segment_header_size + padded) return 0;
    const auto unused = static_cast<unsigned>(padded - data.size());
    store_head(out, service, command, (toggle ? toggle_bit : 0u) | (last ? last_bit : 0u) | (unused << 1));
    const auto end = std::copy(data.begin(), data.end(), out.begin() + sdo_segment_header_size);
    std::fill_n(end, unused, std::byte{0});
    return sdo_segment_header_size + padded;
}

bool take_initiate(std::span<const std::byte> payload, unsigned flags, SdoMessage& message) noexcept {
    if (payload.size() < sdo_initiate_size) return false;
    message.index = load_le<std::uint16_t>(payload, 3);
    message.sub = static_cast<std::uint8_t>(payload[5]);
    message.complete_access = (flags & complete_bit) != 0;
    return true;
}

bool take_value(std::span<const std::byte> payload, unsigned flags, SdoMessage& message) noexcept {
    if (!take_initiate(payload, flags, message)) return false;
    message.expedited = (flags & expedited_bit) != 0;
    if (message.expedited) {
        const std::size_t unused = (flags & size_given) != 0 ? (flags >> 2) & 3u : 0u;
        message.data = payload.subspan(6, 4 - unused);
        message.complete_size = static_cast<std::uint32_t>(message.data.size());
        return true;
    }
    message.complete_size = load_le<std::uint32_t>(payload, 6);
    // The mailbox may be padded: never hand out more than the value has.
    message.data = payload.subspan(sdo_initiate_size, std::min<std::size_t>(payload.size() - sdo_initiate_size, message.complete_size));
    return true;
}

bool take_segment(std::span<const std::byte> payload, unsigned flags, SdoMessage& message) noexcept {
    message.toggle = (flags & toggle_bit) != 0;
    message.last = (flags & last_bit) != 0;
    message.data = payload.subspan(sdo_segment_header_size);
    // "Unused" counts only in a segment of the minimum size; in longer ones all bytes are data.
    const std::size_t unused = (flags >> 1) & 7u;
    if (message.data.size() == sdo_segment_minimum) message.data = message.data.first(sdo_segment_minimum - unused);
    return true;
}

bool take_toggle(unsigned flags, SdoMessage& message) noexcept {
    message.toggle = (flags & toggle_bit) != 0;
    return true;
}

constexpr auto aborts = std::to_array<SdoAbortInfo>({
    {0x05030000, "toggle bit did not change"},
    {0x05040000, "SDO protocol timeout"},
    {0x05040001, "command not valid or unknown"},
    {0x05040005, "out of memory"},
    {0x06010000, "unsupported access to an object"},
    {0x06010001, "object is write-only"},
    {0x06010002, "object is read-only"},
    {0x06010003, "subindex cannot be written, subindex 0 must be 0 for write access"},
    {0x06010004, "complete access is not supported for this object"},
    {0x06010005, "object is longer than the mailbox"},
    {0x06010006, "object is mapped to an RxPDO: SDO download is blocked"},
    {0x06020000, "object does not exist"},
    {0x06040041, "object cannot be mapped to a PDO"},
    {0x06040042, "number and length of the mapped objects exceed the PDO length"},
    {0x06040043, "general parameter incompatibility"},
    {0x06040047, "general internal incompatibility in the device"},
    {0x06060000, "access failed because of a hardware error"},
    {0x06070010, "data type or length does not match"},
    {0x06070012, "data too long"},
    {0x06070013, "data too short"},
    {0x06090011, "subindex does not exist"},
    {0x06090030, "value out of range"},
    {0x06090031, "value too high"},
    {0x06090032, "value too low"},
    {0x06090036, "maximum is less than minimum"},
    {0x08000000, "general error"},
    {0x08000020, "data cannot be transferred or stored to the application"},
    {0x08000021, "data cannot be stored because of local control"},
    {0x08000022, "data cannot be stored in the present device state"},
    {0x08000023, "object dictionary is not present or could not be generated"},
});

}  // namespace

std::optional<CoeService> coe_service(std::span<const std::byte> payload) noexcept {
    if (payload.size() < coe_header_size) return std::nullopt;
    return static_cast<CoeService>(load_le<std::uint16_t>(payload, 0) >> 12);
}

std::optional<SdoMessage> parse_sdo(std::span<const std::byte> payload) noexcept {
    if (payload.size() < sdo_segment_header_size) return std::nullopt;
    const auto service = coe_service(payload);
    if (service != CoeService::sdo_request && service != CoeService::sdo_response) return std::nullopt;
    const auto byte = static_cast<unsigned>(payload[2]);
    const unsigned command = byte >> 5;
    const unsigned flags = byte & 0x1Fu;

    SdoMessage message;
    bool taken = false;
    if (command == abort_transfer) {
        message.kind = SdoKind::abort;
        taken = take_initiate(payload, 0, message);
        if (taken) message.abort_code = load_le<std::uint32_t>(payload, 6);
    } else if (service == CoeService::sdo_request) {
        switch (command) {
            case download_segment:
                message.kind = SdoKind::download_segment_request;
                taken = take_segment(payload, flags, message);
                break;
            case download:
                message.kind = SdoKind::download_request;
                taken = take_value(payload, flags, message);
                break;
            case upload:
                message.kind = SdoKind::upload_request;
                taken = take_initiate(payload, flags, message);
                break;
            case upload_segment:
                message.kind = SdoKind::upload_segment_request;
                taken = take_toggle(flags, message);
                break;
            default: break;
        }
    } else {
        switch (command) {
            case upload_segment_done:
                message.kind = SdoKind::upload_segment_response;
                taken = take_segment(payload, flags, message);
                break;
            case download_segment_done:
                message.kind = SdoKind::download_segment_response;
                taken = take_toggle(flags, message);
                break;
            case upload_done:
                message.kind = SdoKind::upload_response;
                taken = take_value(payload, flags, message);
                break;
            case download_done:
                message.kind = SdoKind::download_response;
                taken = take_initiate(payload, flags, message);
                break;
            default: break;
        }
    }
    if (!taken) return std::nullopt;
    return message;
}

std::size_t encode_upload_request(std::span<std::byte> out, std::uint16_t index, std::uint8_t sub, bool complete_access) noexcept {
    return encode_initiate(out, CoeService::sdo_request, upload, complete_access ? complete_bit : 0u, index, sub, 0);
}

std::size_t encode_download_request(std::span<std::byte> out, std::uint16_t index, std::uint8_t sub, std::span<const std::byte> data,
                                    bool complete_access) noexcept {
    return encode_with_data(out, CoeService::sdo_request, download, index, sub, data, complete_access);
}

std::size_t encode_upload_response(std::span<std::byte> out, std::uint16_t index, std::uint8_t sub, std::span<const std::byte> data,
                                   bool complete_access) noexcept {
    return encode_with_data(out, CoeService::sdo_response, upload_done, index, sub, data, complete_access);
}

std::size_t encode_download_response(std::span<std::byte> out, std::uint16_t index, std::uint8_t sub, bool complete_access) noexcept {
    return encode_initiate(out, CoeService::sdo_response, download_done, complete_access ? complete_bit : 0u, index, sub, 0);
}

std::size_t encode_upload_segment_request(std::span<std::byte> out, bool toggle) noexcept {
    return encode_initiate(out, CoeService::sdo_request, upload_segment, toggle ? toggle_bit : 0u, 0, 0, 0);
}

std::size_t encode_upload_segment_response(std::span<std::byte> out, bool toggle, bool last, std::span<const std::byte> data) noexcept {
    return encode_segment(out, CoeService::sdo_response, upload_segment_done, toggle, last, data);
}

std::size_t encode_download_segment_request(std::span<std::byte> out, bool toggle, bool last, std::span<const std::byte> data) noexcept {
    return encode_segment(out, CoeService::sdo_request, download_segment, toggle, last, data);
}

std::size_t encode_download_segment_response(std::span<std::byte> out, bool toggle) noexcept {
    return encode_initiate(out, CoeService::sdo_response, download_segment_done, toggle ? toggle_bit : 0u, 0, 0, 0);
}

std::size_t encode_sdo_abort(std::span<std::byte> out, std::uint16_t index, std::uint8_t sub, std::uint32_t code) noexcept {
    return encode_initiate(out, CoeService::sdo_request, abort_transfer, 0, index, sub, code);
}

std::span<const SdoAbortInfo> sdo_abort_codes() noexcept { return aborts; }

std::string_view sdo_abort_text(std::uint32_t code) noexcept {
    for (const auto& info : aborts)
        if (info.code == code) return info.text;
    return "unknown abort code";
}

std::optional<Emergency> parse_emergency(std::span<const std::byte> payload) noexcept {
    if (payload.size() < emergency_size || coe_service(payload) != CoeService::emergency) return std::nullopt;
    Emergency emergency;
    emergency.code = load_le<std::uint16_t>(payload, 2);
    emergency.error_register = static_cast<std::uint8_t>(payload[4]);
    std::copy_n(payload.begin() + 5, emergency.data.size(), emergency.data.begin());
    return emergency;
}

std::size_t encode_emergency(std::span<std::byte> out, const Emergency& emergency) noexcept {
    if (out.size() < emergency_size) return 0;
    store_le<std::uint16_t>(out, 0, static_cast<std::uint16_t>(static_cast<unsigned>(CoeService::emergency) << 12));
    store_le<std::uint16_t>(out, 2, emergency.code);
    out[4] = static_cast<std::byte>(emergency.error_register);
    std::copy(emergency.data.begin(), emergency.data.end(), out.begin() + 5);
    return emergency_size;
}

}  // namespace taktwerk::ecat
