#include "config/esi_import/esi_import.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>

#include <fmt/format.h>

#include "config/esi_import/import_parts.hpp"

namespace taktwerk::config {

namespace {

using namespace ecat::esi;

constexpr std::size_t longest_name = 40;

bool is_name(const std::string& text) {
    return !text.empty() && text.size() <= longest_name && std::isalpha(static_cast<unsigned char>(text.front())) != 0 &&
           std::all_of(text.begin(), text.end(),
                       [](unsigned char c) { return (c < 0x80 && std::isalnum(c) != 0) || c == '_' || c == '-'; });
}

/// ETG.2000, CheckRevisionNo: EQ, EQ_OR_G, and both for the low and the high word.
void import_revision(const EsiHeading& from, EsiImport& to) {
    auto& rule = to.file.device.revision_rule;
    if (from.check_revision == "EQ") rule = ecat::RevisionRule::exact;
    else if (from.check_revision.empty() || from.check_revision == "EQ_OR_G") rule = ecat::RevisionRule::at_least;
    else if (from.check_revision == "NONE") rule = ecat::RevisionRule::any;
    else {
        rule = ecat::RevisionRule::at_least;
        to.leftovers.push_back({fmt::format("revisions are compared by {}", from.check_revision),
                                "here a later one is taken: compare the low half, where variants differ"});
    }
    if (from.hidden)
        to.leftovers.push_back(
            {"this revision is hidden: newer ones take its place", "import the newest, unless this is the one you have"});
}

void import_times(const EsiDevice& from, EsiImport& to) {
    const auto add = [&](const std::optional<Duration>& time, const char* what) {
        if (time)
            to.leftovers.push_back({fmt::format("{} {} ms", what, std::chrono::duration_cast<std::chrono::milliseconds>(*time).count()),
                                    "the master has times of its own"});
    };
    if (from.mailbox) {
        add(from.mailbox->request_timeout, "mailbox: a request may take");
        add(from.mailbox->response_timeout, "mailbox: an answer may take");
    }
    add(from.timeouts.preop, "to PREOP it may take");
    add(from.timeouts.safeop_op, "to SAFEOP and OP it may take");
    add(from.timeouts.back_to_init, "back to INIT it may take");
    add(from.timeouts.back_to_safeop, "back to SAFEOP it may take");
}

/// What is in the vendor's file and was of no use, or could not be read.
void import_rest(const EsiReading& reading, EsiImport& to) {
    const auto& from = reading.device;
    if (std::find(from.profiles.begin(), from.profiles.end(), 402u) != from.profiles.end())
        to.leftovers.push_back({"it is a drive (profile 402)",
                                "as a `device:` its values can be read and written by programs, and no axis can be on it: that needs a "
                                "drive file (config/drives/README.md)"});
    if (from.eeprom) to.leftovers.push_back({"contents of its EEPROM", "it brings its own"});
    if (!from.physics.empty()) to.leftovers.push_back({fmt::format("kinds of its ports ({})", from.physics), "the bus tells them"});
    if (!from.fmmus.empty())
        to.leftovers.push_back({fmt::format("what its {} FMMUs are for", from.fmmus.size()), "the master hands them out itself"});
    if (from.controller.dpram_size)
        to.leftovers.push_back({fmt::format("memory of {} bytes", *from.controller.dpram_size), "taken as 4 KB of process data"});
    for (const auto& remark : reading.remarks) to.leftovers.push_back({fmt::format("{}: {}", remark.subject, remark.what), remark.remedy});
    for (const auto& part : reading.unread)
        to.leftovers.push_back({fmt::format("{} ({}, first in line {})", part.path, part.count, part.line), "not read"});
}

}  // namespace

std::string device_file_name(const std::string& type) {
    std::string out;
    for (const char c : type) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x80 && std::isalnum(byte) != 0) out += static_cast<char>(std::tolower(byte));
        else if (!out.empty() && out.back() != '-') out += c == '_' ? '_' : '-';
    }
    if (out.empty() || std::isalpha(static_cast<unsigned char>(out.front())) == 0) out = "device-" + out;
    out.resize(std::min(out.size(), longest_name));
    while (!out.empty() && (out.back() == '-' || out.back() == '_')) out.pop_back();
    return out == "null" ? "device-null" : out;  // which is no word in YAML
}

Result<EsiImport> import_device(const EsiReading& reading, const std::string& vendor, const std::string& source, const std::string& name) {
    const auto& from = reading.device;
    const auto& head = from.heading;
    if (!reading.problems.empty()) {
        auto error = reading.problems.front();
        if (reading.problems.size() > 1)
            error.what += fmt::format(" (the first of {} problems: `taktwerk esi show` lists them)", reading.problems.size());
        return error;
    }
    EsiImport to;
    to.file.name = name.empty() ? device_file_name(head.type) : name;
    if (!is_name(to.file.name))
        return Error{
            "esi.name", to.file.name, "no device can be called so: it is the name of its file, and machines write `device: NAME`",
            fmt::format("call the file {}.yaml: up to 40 letters, digits, `_` and `-`, with a letter first", device_file_name(head.type))};
    to.file.version = 1;
    to.file.vendor = vendor.empty() ? fmt::format("vendor {:08X}h", head.identity.vendor) : vendor;
    to.file.title = head.name.empty() ? head.type : head.name;
    if (to.file.title.empty()) to.file.title = to.file.name;
    to.file.source = fmt::format("{} (ESI), {} revision {:08X}h", source, head.type, head.identity.revision);
    to.file.checked = "vendor_file";
    auto& device = to.file.device;
    device.device_name = head.type.empty() ? to.file.name : head.type;
    device.identity = head.identity;
    import_revision(head, to);
    if (from.ebus_current) device.ebus_current = static_cast<std::int16_t>(*from.ebus_current);
    if (auto done = import_process_data(from, to); !done) return done.error();
    if (auto done = import_slots(from, to); !done) return done.error();
    import_objects(from, to);
    import_channels(from, to);
    import_startup(from, to);
    import_clock(from, to);
    import_times(from, to);
    import_rest(reading, to);
    return to;
}

}  // namespace taktwerk::config
