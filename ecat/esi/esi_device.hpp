#pragma once
// What an ESI file says of one device, as plain data: the vendor's words, before anything of it is ours. Names follow ETG.2000. Not real-time.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "ecat/description/device_description.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::ecat::esi {

struct EsiEntry {
    std::uint16_t index = 0;  ///< 0: padding
    std::uint8_t sub = 0;
    std::uint32_t bits = 0;
    std::string name, type;        ///< type as written: "UINT", "BIT2", "ARRAY [0..3] OF BYTE"
    bool depends_on_slot = false;  ///< each slot adds its increment to the index
};

struct EsiPdo {
    std::uint16_t index = 0;
    std::string name;
    std::vector<EsiEntry> entries;
    std::optional<std::uint8_t> sync_manager;  ///< it is assigned to this one from the factory; none: offered only
    bool fixed = false, mandatory = false, is_virtual = false, depends_on_slot = false;
    std::vector<std::uint16_t> excludes;   ///< PDOs that cannot be assigned with it
    std::optional<unsigned> oversampling;  ///< OSFac: copies that are exchanged a cycle
};

struct EsiSyncManager {
    std::optional<SmUse> use;  ///< none: neither its text nor its control byte says it
    std::uint16_t start = 0;
    std::uint16_t size = 0;
    std::uint8_t control = 0;
    bool enable = true, is_virtual = false, op_only = false;
};

/// One object or one sub-index, with what its data type says.
struct EsiObject {
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    std::string name, type;
    std::optional<DataType> basic;  ///< none: nothing that our dictionaries hold, such as ARRAY OF BYTE or UINT24
    std::uint32_t bits = 0;
    Access access = Access::ro;
    Mappable mappable = Mappable::no;
    std::optional<std::int64_t> value, minimum, maximum;
    std::string text;  ///< default of a STRING
    std::string unit, meaning;
};

/// Something that the vendor wants written while the slave comes up.
struct EsiInitCommand {
    std::vector<std::string> transitions;  ///< "IP", "PS", "SO"
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    std::vector<std::byte> data;  ///< as on the wire, least byte first
    bool complete_access = false;
    std::string comment;
};

struct EsiCoe {
    bool sdo_info = false, pdo_assign = false, pdo_config = false, pdo_upload = false, complete_access = false, segmented_sdo = false;
};

struct EsiMailbox {
    bool data_link_layer = false;  ///< mailboxes repeat what was lost
    std::optional<EsiCoe> coe;
    std::vector<std::string> other_protocols;  ///< "EoE", "FoE", "SoE", "AoE", "VoE"
    std::vector<EsiInitCommand> init_commands;
    std::optional<Duration> request_timeout, response_timeout;
};

/// A way in which the slave keeps time. A cycle of 0 is that of the bus times the factor, or divided by it where that is negative.
struct EsiOpMode {
    std::string name, description;
    std::uint16_t assign_activate = 0;  ///< for registers 0980h and 0981h; 0: without a clock
    Duration sync0_cycle{}, sync0_shift{}, sync1_cycle{}, sync1_shift{};
    std::int64_t sync0_factor = 0, sync1_factor = 0;  ///< negative: parts of a cycle
};

struct EsiModule {
    std::uint32_t ident = 0;
    std::string type, name, module_class;
    std::vector<EsiPdo> rx, tx;
    std::vector<EsiObject> objects;
    std::vector<EsiInitCommand> init_commands;
};

struct EsiSlot {
    std::string name;
    unsigned minimum = 0, maximum = 1;  ///< instances
    std::vector<std::uint32_t> idents;
    std::vector<std::string> classes;
    std::optional<std::uint32_t> default_ident;
    std::optional<std::uint16_t> pdo_increment, index_increment;  ///< other ones than those of all slots
};

struct EsiSlots {
    unsigned maximum = 0;  ///< 0: not stated
    std::uint16_t pdo_increment = 0, index_increment = 0;
    std::string identify_by;
    bool download_idents = false;  ///< F030h is to be written
    std::vector<EsiSlot> slots;
};

struct EsiController {
    std::optional<unsigned> dpram_size, sync_managers, fmmus;
};

struct EsiEeprom {
    unsigned size = 0;                         ///< bytes
    std::vector<std::byte> config, bootstrap;  ///< words 0..6, words 14h..17h
    std::vector<SiiOtherCategory> categories;  ///< the vendor's own
    std::vector<std::byte> data;               ///< the whole of it; then nothing else is said
};

struct EsiStateTimeouts {
    std::optional<Duration> preop, safeop_op, back_to_init, back_to_safeop;
};

/// Who it is: enough for a list.
struct EsiHeading {
    std::string type;     ///< "EL3104"
    std::string name;     ///< in English where there is one
    std::string chinese;  ///< where it has one
    std::string group;    ///< "Analog Input Terminals (EL3xxx)"
    std::string url;
    Identity identity;
    std::string check_revision;           ///< CheckRevisionNo: "EQ_OR_G", ...
    std::vector<std::uint32_t> replaces;  ///< HideType: revisions of this product that are not offered any longer
    bool hidden = false;                  ///< replaced by another device of the file, or Invisible
    std::size_t line = 0;                 ///< of the file
};

struct EsiDevice {
    EsiHeading heading;
    std::string physics;  ///< of the ports: "YY", "KK"
    std::vector<unsigned> profiles;
    std::optional<std::int32_t> ebus_current;  ///< mA; negative: it supplies
    bool id_in_al_status = false;              ///< explicit device identification: asked through AL control
    std::optional<std::uint16_t> id_address;   ///< or read there
    std::vector<EsiSyncManager> sync_managers;
    std::vector<std::string> fmmus;
    std::vector<EsiPdo> rx, tx;
    std::optional<EsiMailbox> mailbox;
    std::vector<EsiObject> objects;
    bool has_dc = false;
    std::vector<EsiOpMode> op_modes;
    std::optional<EsiSlots> slots;
    std::vector<EsiModule> modules;  ///< those that its slots take
    std::optional<EsiEeprom> eeprom;
    EsiController controller;
    EsiStateTimeouts timeouts;
};

}  // namespace taktwerk::ecat::esi
