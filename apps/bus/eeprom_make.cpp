// taktwerk bus eeprom make DEVICE -o FILE: an image from a description, the vendor's or one of ours.

#include <algorithm>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "apps/bus/eeprom.hpp"
#include "apps/esi/esi.hpp"
#include "apps/machine/load.hpp"
#include "apps/terminal/exit_code.hpp"
#include "config/device_file/device_loader.hpp"
#include "config/drive_file/drive_library.hpp"
#include "core/bytes.hpp"
#include "core/nearest_name.hpp"
#include "ecat/eeprom/sii_fields.hpp"
#include "ecat/esi/esi_sii.hpp"
#include "ecat/sim/sii_image.hpp"

namespace taktwerk::apps {

namespace {

struct MakeOptions {
    BusOptions how;  ///< --json
    std::string from, machine, output, device, revision, like;
    std::optional<std::uint16_t> alias;
    std::optional<std::uint32_t> serial;
};

struct MadeImage {
    EepromImage image;
    std::vector<std::string> remarks;
};

Result<MadeImage> made_of_esi(const MakeOptions& options) {
    const auto file = ecat::esi::EsiFile::open(options.from);
    if (!file) return file.error();
    const auto read = read_esi_device(*file, options.device, options.revision);
    if (!read) return read.error();
    const auto& reading = *read;
    if (!reading.problems.empty()) return reading.problems.front();
    auto made = ecat::esi::esi_image(reading.device);
    MadeImage out{std::move(made.bytes), std::move(made.leftovers)};
    for (const auto& remark : reading.remarks) out.remarks.push_back(remark.text());
    return out;
}

/// A device or drive file by its name, as machines write it.
Result<MadeImage> made_of_ours(const MakeOptions& options) {
    config::DeviceLibrary devices(device_folders(options.machine));
    config::DriveLibrary drives(drive_folders(options.machine));
    std::shared_ptr<const ecat::DeviceDescription> description;
    if (const auto* device = devices.find(options.from)) description = device->device;
    else if (const auto* drive = drives.find(options.from)) description = drive->device;
    for (const auto* errors : {&devices.errors(), &drives.errors()})
        if (!errors->empty()) return errors->front();
    if (!description) {
        auto names = devices.names();
        for (auto& name : drives.names()) names.push_back(std::move(name));
        const auto near = nearest_name(options.from, names);
        return Error{
            "eeprom.no_device", options.from, "is neither a file nor a device or drive on the bus that is known here",
            near.empty() ? "give an ESI file, or the name of a file in config/devices/ or config/drives/" : "did you mean " + near + "?"};
    }
    MadeImage out{ecat::sim::sii_image(*description, 0), {}};
    out.remarks.emplace_back(
        "words 0 to 3 (PDI, SYNC pulse) and the kinds of its ports are those of our simulated slave: a device file does not know them. For "
        "a real one "
        "take them from its backup (--like), or use the vendor's ESI file");
    return out;
}

/// What belongs to the one slave, and no description knows.
Result<void> make_like(MadeImage& made, const std::string& path) {
    const auto like = read_eeprom_file(path);
    if (!like) return like.error();
    if (like->size() < ecat::sii_header_bytes || ecat::parse_sii(*like).has(ecat::SiiDefect::bad_checksum))
        return Error{"eeprom.image", path, "its header is damaged", "give a backup of a slave that works"};
    const auto copy = [&](std::size_t word, std::size_t words) {
        std::copy_n(like->begin() + static_cast<std::ptrdiff_t>(2 * word), 2 * words,
                    made.image.begin() + static_cast<std::ptrdiff_t>(2 * word));
    };
    copy(0, ecat::sii_word::checksum + 1u);
    copy(ecat::sii_word::serial, 2);
    copy(ecat::sii_word::size, 1);
    return {};
}

int make_image(const MakeOptions& options) {
    std::error_code ignored;
    auto made = std::filesystem::is_regular_file(options.from, ignored) ? made_of_esi(options) : made_of_ours(options);
    if (!made) return fail(options.how, made.error());
    if (!options.like.empty())
        if (const auto done = make_like(*made, options.like); !done) return fail(options.how, done.error());
    if (options.serial) store_le<std::uint32_t>(made->image, 2 * ecat::sii_word::serial, *options.serial);
    if (options.alias) ecat::set_sii_alias(made->image, *options.alias);
    if (const auto written = write_eeprom_file(options.output, made->image); !written) return fail(options.how, written.error());
    if (options.how.json) {
        Json json{{"ok", true}, {"file", options.output}};
        json.update(eeprom_json(made->image));
        json["remarks"] = made->remarks;
        print_json(json);
        return exit_ok;
    }
    fmt::print("{}", eeprom_text(options.output, made->image, colours_of_output()));
    for (const auto& remark : made->remarks) fmt::print("\n{}\n", wrapped(remark, 0));
    return exit_ok;
}

}  // namespace

void add_eeprom_make(CLI::App& eeprom, Action& action) {
    auto* sub = eeprom.add_subcommand("make", "an image from a vendor's ESI file, or from a device or drive file; needs no bus");
    auto options = std::make_shared<MakeOptions>();
    sub->add_option("DEVICE", options->from, "an ESI file, or a name such as el3104")->required();
    sub->add_option("-o,--output", options->output, "the image to write")->required()->type_name("FILE");
    sub->add_option("--device", options->device, "of an ESI file with several: type, or number in `esi list`")->type_name("D");
    sub->add_option("--revision", options->revision, "another revision than the newest, such as 0x00140000")->type_name("R");
    sub->add_option("--machine", options->machine, "its devices/ and drives/ are looked through, too")->type_name("FILE");
    sub->add_option("--like", options->like, "take words 0 to 6, the serial number and the size from this backup of the slave")
        ->type_name("FILE");
    sub->add_option("--alias", options->alias, "0 to 65535; default: as described or as in --like")->type_name("N");
    sub->add_option("--serial", options->serial, "default: 0, or as in --like")->type_name("N");
    sub->add_flag("--json", options->how.json, "the answer as one JSON object");
    sub->callback([&action, options] { action = [options] { return make_image(*options); }; });
}

}  // namespace taktwerk::apps
