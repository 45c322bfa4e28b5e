#include "ecat/wire/foe_error.hpp"

#include <algorithm>
#include <array>

namespace taktwerk::ecat {

namespace {

namespace fe = foe_error;

constexpr std::array foe_errors{
    FoeErrorInfo{fe::not_defined, "not defined", "look at the slave's own words, or ask its maker"},
    FoeErrorInfo{fe::not_found, "file not found", "check the name, as the maker writes it; some slaves want it without its ending"},
    FoeErrorInfo{fe::access_denied, "access denied", "the slave does not give this file away, or is operated locally"},
    FoeErrorInfo{fe::disk_full, "disk full", "the file is larger than the slave's memory: is it the right one?"},
    FoeErrorInfo{fe::illegal, "illegal", "the slave does not know this operation, or not in its present state"},
    FoeErrorInfo{fe::packet_number, "wrong packet number", "try again; if it stays, another master speaks to this mailbox"},
    FoeErrorInfo{fe::already_exists, "the file exists already", "choose another name, or remove the file in the slave"},
    FoeErrorInfo{fe::no_user, "no user", "the slave has no user of this name or password"},
    FoeErrorInfo{fe::bootstrap_only, "only in BOOT", "firmware is written with `taktwerk bus firmware`, which takes the slave to BOOT"},
    FoeErrorInfo{fe::not_bootstrap, "not in BOOT", "this file is written in PREOP: `taktwerk bus file write`; or its name is wrong"},
    FoeErrorInfo{fe::no_rights, "wrong password", "give the password that the maker says: --password"},
    FoeErrorInfo{fe::program_error, "program error", "the slave's firmware failed over it: try again, then ask its maker"},
    FoeErrorInfo{fe::wrong_checksum, "wrong checksum", "the file is damaged: fetch it anew"},
    FoeErrorInfo{fe::wrong_firmware, "the firmware does not fit the hardware", "check the type and hardware version that it is made for"},
    FoeErrorInfo{fe::no_file, "no file to read", "check the name"},
    FoeErrorInfo{fe::no_file_header, "its file header is missing or wrong",
                 "this is no firmware of this slave, or a packed one: unpack it"},
    FoeErrorInfo{fe::flash_problem, "its flash cannot be written", "try again; if it stays, the slave is defective"},
    FoeErrorInfo{fe::file_incompatible, "the file does not fit", "check the type and version that it is made for"},
};
constexpr FoeErrorInfo unknown_foe_error{0, "a code of its maker", "look it up in the slave's manual"};

}  // namespace

const FoeErrorInfo& foe_error_info(std::uint32_t code) noexcept {
    const auto found =
        std::find_if(foe_errors.begin(), foe_errors.end(), [&](const FoeErrorInfo& info) { return info.code == usual_foe_code(code); });
    return found != foe_errors.end() ? *found : unknown_foe_error;
}

}  // namespace taktwerk::ecat
