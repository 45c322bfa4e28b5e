// A device as a whole. ETG.2000: Device and Device/Info.

#include <chrono>

#include "ecat/esi/esi_number.hpp"
#include "ecat/esi/read_parts.hpp"

namespace taktwerk::ecat::esi {

namespace {

using std::chrono::milliseconds;

std::optional<Duration> milliseconds_of(const Element& of, const char* child) {
    const auto number = of.number_of(child, 0, i32);
    return number ? std::optional<Duration>(milliseconds(*number)) : std::nullopt;
}

void read_info(const Element& info, EsiDevice& out) {
    info.knows({"Electrical", "StateMachine", "Mailbox", "EtherCATController", "Port", "IdentificationAdo", "IdentificationReg134",
                "StationAliasSupported"});
    const auto electrical = info.child("Electrical");
    if (electrical) electrical.knows({"EBusCurrent"});
    if (const auto current = electrical.number_of("EBusCurrent", -30'000, 30'000)) out.ebus_current = static_cast<std::int32_t>(*current);
    const auto machine = info.child("StateMachine");
    if (machine) machine.knows({"Timeout"});
    if (const auto timeout = machine.child("Timeout")) {
        timeout.knows({"PreopTimeout", "SafeopOpTimeout", "BackToInitTimeout", "BackToSafeopTimeout"});
        out.timeouts = {milliseconds_of(timeout, "PreopTimeout"), milliseconds_of(timeout, "SafeopOpTimeout"),
                        milliseconds_of(timeout, "BackToInitTimeout"), milliseconds_of(timeout, "BackToSafeopTimeout")};
    }
    if (const auto mailbox = info.child("Mailbox")) {
        mailbox.knows({"Timeout"});
        const auto timeout = mailbox.child("Timeout");
        if (timeout && out.mailbox) {
            out.mailbox->request_timeout = milliseconds_of(timeout, "RequestTimeout");
            out.mailbox->response_timeout = milliseconds_of(timeout, "ResponseTimeout");
        }
    }
    out.id_in_al_status = parse_flag(info.text_of("IdentificationReg134")).value_or(false);
    if (const auto address = info.number_of("IdentificationAdo", 0, u16)) out.id_address = static_cast<std::uint16_t>(*address);
    if (const auto controller = info.child("EtherCATController")) {
        controller.knows({"DpramSize", "SmCount", "FmmuCount"});
        const auto count = [&](const char* name) {
            const auto number = controller.number_of(name, 0, u32);
            return number ? std::optional<unsigned>(static_cast<unsigned>(*number)) : std::nullopt;
        };
        out.controller = {count("DpramSize"), count("SmCount"), count("FmmuCount")};
    }
}

/// Numbers least byte first; a text as it stands, as categories have it.
std::vector<std::byte> category_bytes(const Element& category) {
    std::vector<std::byte> out;
    for (const auto& part : category.children("Data"))
        for (const auto byte : parse_bytes(part.text()).value_or(std::vector<std::byte>{})) out.push_back(byte);
    for (const auto& part : category.children("DataString"))
        for (const char c : part.text()) out.push_back(static_cast<std::byte>(c));
    const auto add_numbers = [&](const char* name, std::int64_t largest, unsigned bytes) {
        for (const auto& part : category.children(name)) {
            const auto number = static_cast<std::uint64_t>(part.number(0, largest).value_or(0));
            for (unsigned n = 0; n < bytes; ++n) out.push_back(static_cast<std::byte>((number >> (8 * n)) & 0xFFu));
        }
    };
    add_numbers("DataUINT", u16, 2);
    add_numbers("DataUDINT", u32, 4);
    if (out.size() % 2 != 0) out.push_back(std::byte{0});  // categories have words
    return out;
}

std::vector<SiiOtherCategory> read_categories(const Element& eeprom) {
    std::vector<SiiOtherCategory> out;
    for (const auto& category : eeprom.children("Category")) {
        category.knows({"CatNo", "Data", "DataString", "DataUINT", "DataUDINT"}, {"PreserveOnlineData"});
        const auto number = category.required_number_of("CatNo", 0, u16);
        unsigned kinds = 0;
        for (const char* kind : {"Data", "DataString", "DataUINT", "DataUDINT"}) kinds += category.child(kind) ? 1 : 0;
        if (kinds > 1)
            category.problem("esi.category", "data of several kinds stand in one category",
                             "their order is not kept: compare the image that is made of it");
        if (number) out.push_back({static_cast<std::uint16_t>(*number), category_bytes(category)});
    }
    return out;
}

EsiEeprom read_eeprom(const Element& eeprom) {
    eeprom.knows({"ByteSize", "ConfigData", "BootStrap", "Category", "Data"});
    EsiEeprom out;
    out.size = static_cast<unsigned>(eeprom.number_of("ByteSize", 0, u32).value_or(0));
    out.config = parse_bytes(eeprom.text_of("ConfigData")).value_or(std::vector<std::byte>{});
    out.bootstrap = parse_bytes(eeprom.text_of("BootStrap")).value_or(std::vector<std::byte>{});
    out.categories = read_categories(eeprom);
    out.data = parse_bytes(eeprom.text_of("Data")).value_or(std::vector<std::byte>{});
    return out;
}

}  // namespace

EsiHeading read_heading(const Element& device, std::uint32_t vendor) {
    EsiHeading out;
    const auto type = device.child("Type");
    out.type = type.text();
    if (!type) device.problem("esi.missing", "it has no Type", "add <Type ProductCode=\"...\" RevisionNo=\"...\">...</Type>");
    out.name = device.in_english("Name");
    out.chinese = device.in_chinese("Name");
    out.url = device.in_english("URL");
    out.identity.vendor = vendor;
    if (type && type.attribute("ProductCode").empty())
        type.problem("esi.no_product", "it has no ProductCode: a part without a controller, which no bus ever shows",
                     "choose a device that has one; terminals that only hand on or feed in power need no file");
    else if (type) {
        out.identity.product = static_cast<std::uint32_t>(type.required_number_in("ProductCode", 0, u32).value_or(0));
        out.identity.revision = static_cast<std::uint32_t>(type.number_in("RevisionNo", 0, u32).value_or(0));
    }
    out.check_revision = type.attribute("CheckRevisionNo");
    for (const auto& old : device.children("HideType"))
        if (const auto revision = old.number_in("RevisionNo", 0, u32)) out.replaces.push_back(static_cast<std::uint32_t>(*revision));
    const auto invisible = parse_flag(device.attribute("Invisible"));
    out.hidden = invisible.value_or(false);
    out.line = device.line();
    return out;
}

void read_device(const Element& device, EsiDevice& out) {
    device.knows({"Type", "HideType", "Name", "URL", "Info", "GroupType", "Profile", "Fmmu", "Sm", "RxPdo", "TxPdo", "Mailbox", "Dc",
                  "Slots", "Eeprom"},
                 {"Physics", "Invisible"});
    device.child("Type").knows({}, {"ProductCode", "RevisionNo", "CheckProductCode", "CheckRevisionNo"});
    out.physics = device.attribute("Physics");
    for (const auto& sm : device.children("Sm")) out.sync_managers.push_back(read_sync_manager(sm));
    for (const auto& fmmu : device.children("Fmmu")) out.fmmus.push_back(fmmu.text());
    for (const auto& pdo : device.children("RxPdo")) out.rx.push_back(read_pdo(pdo));
    for (const auto& pdo : device.children("TxPdo")) out.tx.push_back(read_pdo(pdo));
    if (const auto mailbox = device.child("Mailbox")) out.mailbox = read_mailbox(mailbox);
    for (const auto& profile : device.children("Profile")) read_profile(profile.can_do_without(), out.profiles, out.objects);
    if (const auto dc = device.child("Dc")) {
        out.has_dc = true;
        out.op_modes = read_op_modes(dc);
    }
    if (const auto slots = device.child("Slots")) out.slots = read_slots(slots);
    if (const auto eeprom = device.child("Eeprom")) out.eeprom = read_eeprom(eeprom.can_do_without());
    if (const auto info = device.child("Info")) read_info(info.can_do_without(), out);
}

}  // namespace taktwerk::ecat::esi
