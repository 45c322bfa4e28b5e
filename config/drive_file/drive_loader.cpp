#include "config/drive_file/drive_loader.hpp"

#include <filesystem>

#include <fmt/format.h>

#include "config/drive_file/based_on.hpp"
#include "config/drive_file/drive_tables.hpp"
#include "config/drive_file/pdo_selection.hpp"
#include "ecat/description/module_pdos.hpp"

namespace taktwerk::config {

namespace {

void load_alarms(const std::string& path, axes::DriveProfile& profile, std::vector<Error>& errors) {
    auto document = read_document(path);
    Reader reader(path);
    reader.errors() = std::move(document.errors);
    AlarmFile file;
    if (document.root.kind != Node::Kind::null) read_table(reader, document.root, alarm_table(), file);
    errors.insert(errors.end(), reader.errors().begin(), reader.errors().end());
    profile.alarms.insert(profile.alarms.end(), file.alarms.begin(), file.alarms.end());
}

void load_objects(const std::string& path, DriveFile& drive, std::vector<Error>& errors) {
    auto document = read_document(path);
    Reader reader(path);
    reader.errors() = std::move(document.errors);
    ObjectFile file;
    if (document.root.kind != Node::Kind::null) read_table(reader, document.root, object_file_table(), file);
    errors.insert(errors.end(), reader.errors().begin(), reader.errors().end());
    add_objects(drive, file.objects);
}

ecat::PdoSelection chosen(const std::vector<PdoChoice>& choices, const std::vector<ecat::PdoDescription>& available) {
    ecat::PdoSelection out;
    for (const auto& choice : choices)
        for (const auto& pdo : available)
            if (pdo.index == choice.pdo.index) {
                out.assigned.push_back(pdo);
                if (!choice.objects.empty()) out.assigned.back().entries = choice.objects;
                out.required.insert(out.required.end(), choice.required.begin(), choice.required.end());
            }
    return out;
}

/// The same module in every slot.
std::vector<ecat::ModuleSelection> in_every_slot(Reader& reader, const DriveFile& file) {
    std::vector<ecat::ModuleSelection> out;
    if (file.module.empty()) return out;
    const auto& slots = file.device.slots;
    if (ecat::find_module(slots, file.module) == nullptr)
        reader.problem(reader.find("mapping.module"), "config.mapping", fmt::format("`slots.modules` has no module '{}'", file.module),
                       "name one of them");
    for (std::uint8_t slot = 0; slot < slots.count; ++slot) out.push_back({slot, file.module});
    return out;
}

}  // namespace

std::variant<LoadedDrive, std::vector<Error>> load_drive(const std::string& path, const std::vector<std::string>& folders) {
    auto document = read_drive_document(path, folders);
    Reader reader(path);
    reader.errors() = std::move(document.errors);
    DriveFile file;
    const bool serial = document.root.find("carried_by") != nullptr;
    if (document.root.kind != Node::Kind::null) read_table(reader, document.root, serial ? serial_drive_table() : drive_table(), file);
    // A file that is based on another may use what lies beside that one.
    const auto beside = [&](const std::string& name) {
        const auto here = std::filesystem::path(path).parent_path() / name;
        if (std::filesystem::exists(here)) return here.string();
        for (const auto& folder : folders)
            if (const auto there = std::filesystem::path(folder) / name; std::filesystem::exists(there)) return there.string();
        return here.string();
    };
    std::vector<std::string> files{path};
    if (!document.based_on.empty()) files.push_back(document.based_on);
    if (!file.object_file.empty()) load_objects(files.emplace_back(beside(file.object_file)), file, reader.errors());
    const auto modules = in_every_slot(reader, file);
    const auto startup = resolve_startup(reader, path, file.startup, file.device);
    if (!file.alarm_file.empty()) load_alarms(files.emplace_back(beside(file.alarm_file)), file.profile, reader.errors());
    if (!reader.errors().empty()) return std::move(reader.errors());

    LoadedDrive drive;
    drive.files = std::move(files);
    if (serial) {
        drive.profile = std::make_shared<const axes::DriveProfile>(std::move(file.profile));
        return drive;
    }
    drive.source = file.source, drive.checked = file.checked;
    file.device.name = file.profile.name;
    using Part = axes::AssumedPart;
    file.device.stated = {!file.profile.assumes(Part::identity), !file.profile.assumes(Part::controller),
                          !file.profile.assumes(Part::process_data)};
    drive.rx = chosen(file.rx, file.device.rx_pdos);
    drive.tx = chosen(file.tx, file.device.tx_pdos);
    drive.modules = modules;
    drive.startup = startup;
    drive.device = std::make_shared<const ecat::DeviceDescription>(std::move(file.device));
    drive.profile = std::make_shared<const axes::DriveProfile>(std::move(file.profile));
    return drive;
}

}  // namespace taktwerk::config
