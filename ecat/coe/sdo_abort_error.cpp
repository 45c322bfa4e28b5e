#include <fmt/format.h>

#include <cstdlib>

#include "ecat/coe/sdo_client.hpp"

namespace taktwerk::ecat {

namespace {

const char* remedy_of(std::uint32_t code) {
    switch (code) {
        case sdo_abort::no_object: return "this firmware does not have the object: check the profile against the drive's manual";
        case sdo_abort::no_subindex: return "this firmware does not have the sub-index: check the profile against the drive's manual";
        case sdo_abort::read_only: return "the object cannot be written: remove it from the start-up list";
        case sdo_abort::write_only: return "the object cannot be read; a start-up entry for it needs `verify: false`";
        case sdo_abort::device_state:
        case sdo_abort::local_control: return "the drive does not accept it in its present state: disable the axis, or write it in PREOP";
        case sdo_abort::value_range:
        case sdo_abort::value_too_high:
        case sdo_abort::value_too_low: return "choose a value within the range the manual gives";
        case sdo_abort::wrong_length:
        case sdo_abort::too_long:
        case sdo_abort::too_short: return "the data type does not fit the object: check the type in the profile or start-up list";
        case sdo_abort::not_mappable:
        case sdo_abort::pdo_length: return "the drive does not accept this PDO mapping: map fewer or other objects";
        case sdo_abort::no_complete_access: return "read or write the entries one by one";
        default: return "";
    }
}

}  // namespace

Error abort_error(const MailboxEndpoint& mailbox, const std::string& about, std::uint32_t code) {
    return Error{"sdo.abort", mailbox.subject, fmt::format("{} was refused: abort {:08X}h {}", about, code, sdo_abort_text(code)),
                 remedy_of(code)};
}

std::uint32_t abort_code(const Error& error) noexcept {
    if (error.code != "sdo.abort") return 0;
    const auto at = error.what.find("abort ");
    return at == std::string::npos ? 0 : static_cast<std::uint32_t>(std::strtoul(error.what.c_str() + at + 6, nullptr, 16));
}

}  // namespace taktwerk::ecat
