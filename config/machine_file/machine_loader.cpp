#include "config/machine_file/machine_loader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "config/device_file/device_loader.hpp"
#include "config/drive_file/drive_library.hpp"
#include "config/drive_file/pdo_selection.hpp"
#include "config/drive_file/setting_conflicts.hpp"
#include "config/machine_file/floor_checks.hpp"
#include "config/machine_file/io_points.hpp"
#include "config/machine_file/machine_tables.hpp"
#include "config/machine_file/undescribed_drive.hpp"
#include "core/nearest_name.hpp"
#include "hmi_bridge/modbus/offer.hpp"
#include "runtime/check/program_check.hpp"
#include "runtime/group_presence.hpp"
#include "runtime/presence_points.hpp"

namespace taktwerk::config {

namespace {

namespace fs = std::filesystem;

std::string names_or_none(const std::vector<std::string>& words) {
    std::string out;
    for (const auto& word : words) out += (out.empty() ? "" : ", ") + word;
    return out.empty() ? "none" : out;
}

/// Puts names, profiles and terminals together.
class Assembly {
public:
    Assembly(Reader& reader, const std::string& path, const LoadOptions& options, MachineFile file)
        : reader_(reader),
          path_(path),
          options_(options),
          file_(std::move(file)),
          drives_(drive_folders(path, options)),
          devices_(device_folders(path, options)) {}

    LoadedMachine assemble() {
        LoadedMachine out{std::move(file_.machine), std::move(file_.hmi), {}, {}};
        if (options_.simulate) {
            out.machine.bus.interface.clear();
            if (out.machine.bus.ring) out.machine.bus.ring->interface2.clear();
            for (auto& device : out.machine.modbus) device.host.clear();
        }
        // Simulated drives forget where they were, and what a real machine keeps is none of theirs.
        for (auto* kept : {&out.machine.retain.directory, &out.machine.evidence.directory, &out.machine.recording.directory,
                           &out.hmi.history.directory}) {
            if (out.machine.bus.interface.empty()) kept->clear();
            else if (!kept->empty() && fs::path(*kept).is_relative())
                *kept = (options_.state_dir.empty() ? fs::path(path_).parent_path() / *kept : fs::path(options_.state_dir) / *kept)
                            .lexically_normal()
                            .string();
        }
        out.machine.bus.cycle = out.machine.cycle;
        for (std::size_t i = 0; i < file_.slaves.size(); ++i) {
            add_slave(out, file_.slaves[i], i);
            if (file_.slaves[i].broken) forgive(file_.slaves[i].slave.name, out.machine.axes);
            for (std::size_t k = 0; k < i; ++k)
                if (file_.slaves[k].slave.name == file_.slaves[i].slave.name && !file_.slaves[i].slave.name.empty()) {
                    problem(fmt::format("bus.slaves.{}.name", i), "config.duplicate_name", fmt::format("slave {} has this name too", k),
                            "choose different names");
                    forgive(file_.slaves[i].slave.name, out.machine.axes);
                }
        }
        for (auto& binding : out.machine.axes)
            for (const auto& [name, profile] : profiles_) {
                if (name == binding.slave) binding.profile = profile;
                if (name == binding.follower.slave) binding.follower.profile = profile;
            }
        for (auto& binding : out.machine.axes) add_encoder(binding);
        add_stored(out);
        for (const auto& binding : out.machine.axes) check_axis_is_named(binding);
        for (const auto& entry : file_.serial) add_line(out, entry);
        for (const auto& entry : file_.inputs) add_point(out, entry, runtime::IoDirection::input);
        for (const auto& entry : file_.outputs) add_point(out, entry, runtime::IoDirection::output);
        for (auto& point : runtime::presence_points(out.machine.bus)) out.machine.io.push_back(std::move(point));
        for (const auto& entry : file_.programs) add_program(out, entry);
        for (auto& entry : file_.cams) {
            out.machine.cams.push_back(std::move(entry.cam));
            out.warnings.insert(out.warnings.end(), entry.remarks.begin(), entry.remarks.end());
        }
        for (const auto& entry : file_.groups) {
            out.machine.axis_groups.push_back(made_of(reader_, entry, reader_.units_of_axes));
            check_travel(reader_, entry, out.machine.axes);
        }
        for (auto& entry : file_.paths) {
            complete(reader_, entry, fs::path(path_).parent_path().string());
            out.machine.paths.push_back(entry.path);
        }
        list_files(out);
        check_wiring(out.machine);
        check_events(out.machine);
        add_warnings(out);
        reader_.errors().insert(reader_.errors().end(), drives_.errors().begin(), drives_.errors().end());
        reader_.errors().insert(reader_.errors().end(), devices_.errors().begin(), devices_.errors().end());
        return out;
    }

private:
    void add_slave(LoadedMachine& out, const SlaveEntry& entry, std::size_t place) {
        ecat::SlaveConfig slave = entry.slave;
        if (slave.hot_connect.empty()) {
            if (!slave.position && !slave.alias && !slave.device_id) slave.position = static_cast<std::uint16_t>(always_there_);
            ++always_there_;
        }
        const auto here = fmt::format("bus.slaves.{}", place);
        if (!entry.profile.empty()) add_drive(slave, entry, here, out.machine.axes);
        else if (entry.terminal) add_device(slave, digital_terminal(entry.terminal->inputs, entry.terminal->outputs));
        else if (!entry.device.empty()) add_known_device(slave, entry, here, out.machine.axes);
        if (slave.device) {
            slave.dc = entry.dc.value_or(slave.device->dc.supported);
            add_startup(slave, entry);
        }
        out.machine.bus.slaves.push_back(std::move(slave));
    }

    /// What counts, of an axis that only measures or has an analog drive: by its place among the encoders of its terminal's file, by a channel, or by
    /// an object of any slave. Until here `binding.encoder` is what the axis itself says.
    void add_encoder(runtime::AxisBinding& binding) {
        const auto here = "axes." + binding.axis.name;
        const auto own = std::exchange(binding.encoder, std::nullopt).value_or(axes::EncoderChannel{});
        const auto refuse = [&](const char* key, const char* code, std::string what, std::string remedy) {
            problem(here + key, code, std::move(what), std::move(remedy));
            for (const char* place : {".slave", ".axis"}) reader_.mark_bad(here + place);
        };
        const auto device = devices_of_.find(binding.slave);
        const bool terminal = device != devices_of_.end(), by_object = own.position.index != 0;
        const bool says = by_object || !own.name.empty() || own.bits != 0;
        const bool reads = binding.axis.encoder || binding.analog;
        if (says && (!reads || (!terminal && !by_object)))
            return refuse("", "config.no_encoder",
                          "`channel`, `object` and `counter_bits` are of an axis that only measures, at a terminal",
                          "write `encoder: true`, and the terminal that counts as its `slave`");
        if (!reads || (!terminal && !by_object)) return;
        if (by_object) {
            binding.encoder.emplace();
            binding.encoder->name = show_object(own.position.index, own.position.sub);
            binding.encoder->position = own.position;
            binding.profile = nullptr;  // it is no axis of that drive
        } else if (!own.name.empty()) {
            const auto* channel = find_channel(device->second, runtime::IoDirection::input, own.name);
            if (channel == nullptr)
                return refuse(".channel", "config.no_channel", fmt::format("slave '{}' has no input '{}'", binding.slave, own.name),
                              fmt::format("name one of {}", names_or_none(channel_names(device->second, runtime::IoDirection::input))));
            binding.encoder = encoder_of(*channel);
        } else if (const auto& known = device->second.encoders; known.empty()) {
            return refuse(".slave", "config.no_encoder", fmt::format("the file of slave '{}' names no encoder", binding.slave),
                          fmt::format("name the input that counts by `channel` (there is: {})",
                                      names_or_none(channel_names(device->second, runtime::IoDirection::input))));
        } else if (known.size() > 1 && !reader_.has(here + ".axis")) {
            return refuse("", "axis.drive_axis_missing",
                          fmt::format("slave '{}' has {} encoders: which one is meant?", binding.slave, known.size()),
                          fmt::format("add `axis:`, 1 to {}", known.size()));
        } else if (binding.drive_axis >= known.size()) {
            return refuse(".axis", "axis.drive_axis",
                          fmt::format("slave '{}' has {} encoders, there is no {}", binding.slave, known.size(), binding.drive_axis + 1),
                          known.size() == 1 ? "remove `axis`" : fmt::format("choose 1 to {}", known.size()));
        } else {
            binding.encoder = known[binding.drive_axis];
        }
        binding.encoder->bits = own.bits;
    }

    /// Of a drive with several axes each axis of the machine says which one it is.
    void check_axis_is_named(const runtime::AxisBinding& binding) {
        const auto here = "axes." + binding.axis.name;
        if (!binding.profile || binding.profile->axes == 1 || reader_.has(here + ".axis")) return;
        problem(
            here, "axis.drive_axis_missing",
            fmt::format("slave '{}' ({}) has {} axes: which one is meant?", binding.slave, binding.profile->name, binding.profile->axes),
            fmt::format("add `axis:`, 1 to {}", binding.profile->axes));
        reader_.mark_bad(here + ".axis");
    }

    void add_line(LoadedMachine& out, const SerialLineEntry& entry) {
        auto line = entry.line;
        if (options_.simulate) line.device.clear();
        for (const auto& listed : entry.drives) {
            const auto here = fmt::format("serial.{}.drives.{}", line.name, listed.drive.drive.name);
            auto drive = listed.drive;
            if (const auto* type = drives_.find(listed.profile)) drive.drive.profile = type->profile;
            else if (!drives_.exists(listed.profile)) no_such_drive(here, listed.profile);
            if (!drive.drive.profile) reader_.mark_bad(here + ".profile");
            for (const auto& parameter : listed.parameters) {
                int number = -1;
                const auto* begin = parameter.name.data() + 2;
                const auto* end = parameter.name.data() + parameter.name.size();
                if (parameter.name.size() == 5 && parameter.name.rfind("Pr", 0) == 0 && std::from_chars(begin, end, number).ptr == end)
                    drive.drive.parameters.push_back({static_cast<std::uint16_t>(number), parameter.value});
                else
                    problem(here + ".parameters." + parameter.name, "config.parameter_name",
                            fmt::format("`{}` is no parameter's name", parameter.name), "write it as the manual does, such as Pr097");
            }
            for (auto& binding : out.machine.axes)
                if (binding.drive == drive.drive.name) binding.profile = drive.drive.profile;
            line.drives.push_back(std::move(drive));
        }
        out.machine.serial.push_back(std::move(line));
    }

    /// What others will say about this slave follows from what was said already.
    void forgive(const std::string& slave, const std::vector<runtime::AxisBinding>& axes) {
        reader_.mark_bad(fmt::format("slave '{}'", slave));
        for (const auto& axis : axes)
            if (axis.slave == slave) reader_.mark_bad(fmt::format("axes.{}.slave", axis.axis.name));
    }

    void no_such_drive(const std::string& here, const std::string& profile) {
        const auto names = drives_.names();
        const auto near = nearest_name(profile, names);
        problem(here + ".profile", "config.unknown_profile",
                fmt::format("there is no drive type '{}' in {} (there is: {})", profile, names_or_none(drives_.folders()),
                            names_or_none(names)),
                near.empty() ? "correct the name, or add its file" : fmt::format("did you mean `{}`?", near));
    }

    void add_drive(ecat::SlaveConfig& slave, const SlaveEntry& entry, const std::string& here,
                   const std::vector<runtime::AxisBinding>& axes) {
        const auto* drive = drives_.find(entry.profile);
        if (!drive) {
            forgive(entry.slave.name, axes);
            if (!drives_.exists(entry.profile)) no_such_drive(here, entry.profile);
            return;
        }
        if (!drive->device) {
            forgive(entry.slave.name, axes);
            problem(here + ".profile", "config.not_on_the_bus",
                    fmt::format("{} is a drive on a serial line, not on EtherCAT", entry.profile),
                    "declare it under `serial.<line>.drives`");
            return;
        }
        const auto known = with_statements(*drive, reader_, here, entry.identity, entry.modes);
        slave.device = known.device;
        // The drive's own choice stands in the slots that the machine says nothing about.
        for (const auto& standard : drive->modules)
            if (std::none_of(slave.modules.begin(), slave.modules.end(), [&](const auto& m) { return m.slot == standard.slot; }))
                slave.modules.push_back(standard);
        slave.rx = selection(*drive, slave.modules, PdoWay::rx, entry, here + ".pdo.rx");
        slave.tx = selection(*drive, slave.modules, PdoWay::tx, entry, here + ".pdo.tx");
        slave.startup = drive->startup;
        suit_to_axes(slave, axes);
        profiles_.emplace_back(entry.slave.name, known.profile);
    }

    void add_device(ecat::SlaveConfig& slave, const LoadedDevice& device) {
        slave.device = device.device;
        slave.startup = device.startup;
        devices_of_.emplace(slave.name, device);
    }

    void add_known_device(ecat::SlaveConfig& slave, const SlaveEntry& entry, const std::string& here,
                          const std::vector<runtime::AxisBinding>& axes) {
        const auto* device = devices_.find(entry.device);
        if (!device) {
            forgive(entry.slave.name, axes);
            if (!devices_.exists(entry.device)) no_such_device(here, entry.device);
            return;
        }
        add_device(slave, *device);
        if (!entry.rx.empty()) slave.rx = selected(*device, slave.modules, PdoWay::rx, entry.rx, here + ".pdo.rx");
        if (!entry.tx.empty()) slave.tx = selected(*device, slave.modules, PdoWay::tx, entry.tx, here + ".pdo.tx");
    }

    ecat::PdoSelection selected(const LoadedDevice& device, const std::vector<ecat::ModuleSelection>& modules, PdoWay way,
                                const std::vector<ObjectAddress>& wanted, const std::string& here) {
        auto chosen = select_pdos(*device.device, modules, way, wanted);
        if (chosen) return std::move(*chosen);
        problem(here, chosen.error().code, chosen.error().what, chosen.error().remedy);
        return {};
    }

    void no_such_device(const std::string& here, const std::string& device) {
        const auto names = devices_.names();
        const auto near = nearest_name(device, names);
        const bool is_drive = drives_.exists(device);
        problem(here + ".device", "config.unknown_device",
                is_drive ? fmt::format("'{}' is a drive", device)
                         : fmt::format("there is no device type '{}' in {}", device, names_or_none(devices_.folders())),
                is_drive       ? fmt::format("write `profile: {}`", device)
                : near.empty() ? "correct the name, or add its file (`taktwerk docs devices` lists those there are)"
                               : fmt::format("did you mean `{}`?", near));
    }

    ecat::PdoSelection selection(const LoadedDrive& drive, const std::vector<ecat::ModuleSelection>& modules, PdoWay way,
                                 const SlaveEntry& entry, const std::string& here) {
        const auto& wanted = way == PdoWay::rx ? entry.rx : entry.tx;
        if (wanted.empty()) return way == PdoWay::rx ? drive.rx : drive.tx;
        auto chosen = select_pdos(*drive.device, modules, way, wanted);
        if (chosen) return std::move(*chosen);
        problem(here, chosen.error().code, chosen.error().what, chosen.error().remedy);
        return way == PdoWay::rx ? drive.rx : drive.tx;  // so that nothing is said of what would be missing
    }

    /// The machine's entries replace those of the drive's file for the same object.
    void add_startup(ecat::SlaveConfig& slave, const SlaveEntry& entry) {
        for (auto& sdo : resolve_startup(reader_, path_, entry.startup, *slave.device)) {
            std::erase_if(slave.startup, [&](const ecat::StartupSdo& other) {
                return other.index == sdo.index && other.sub == sdo.sub && other.at == sdo.at && other.origin.rfind(path_, 0) != 0;
            });
            slave.startup.push_back(std::move(sdo));
        }
    }

    /// Objects that a drive looks at when it is switched on only.
    void add_stored(LoadedMachine& out) {
        for (const auto& entry : file_.slaves) {
            const auto known = std::find_if(profiles_.begin(), profiles_.end(), [&](const auto& p) { return p.first == entry.slave.name; });
            refuse_startup_commands(reader_, entry.slave.name, entry.startup, known == profiles_.end() ? nullptr : known->second.get());
            if (known == profiles_.end()) {
                if (!entry.stored.empty() && !entry.broken)
                    reader_.problem(entry.stored.front().where, "config.stored_no_drive",
                                    fmt::format("'{}' is no drive: it keeps nothing", entry.slave.name), "remove `stored`");
                continue;
            }
            refuse_late_startup(reader_, entry.slave.name, entry.startup, *known->second);
            const auto& slaves = out.machine.bus.slaves;
            const auto slave = std::find_if(slaves.begin(), slaves.end(), [&](const auto& s) { return s.name == entry.slave.name; });
            if (slave == slaves.end()) continue;
            for (auto& stored : resolve_stored(reader_, entry.slave.name, entry.stored, slave->startup, *known->second))
                for (auto& binding : out.machine.axes) {
                    if (binding.encoder) continue;  // no axis of the drive
                    if (binding.slave == entry.slave.name && binding.drive_axis == stored.axis) binding.stored.push_back(stored.setting);
                    auto& follower = binding.follower;
                    if (follower.slave == entry.slave.name && follower.drive_axis == stored.axis) follower.stored.push_back(stored.setting);
                }
            for (const auto& binding : out.machine.axes)
                if (binding.slave == entry.slave.name && !binding.encoder)
                    refuse_contradictions(
                        reader_, entry.slave.name, entry.stored, entry.startup, *known->second,
                        {binding.axis.name, binding.drive_axis, binding.axis.gearing.counts_per_revolution, out.machine.cycle, slave->dc});
        }
    }

    void add_point(LoadedMachine& out, const IoEntry& entry, runtime::IoDirection direction) {
        const auto slave = std::ranges::find(file_.slaves, entry.point.slave, [](const SlaveEntry& s) { return s.slave.name; });
        PointPlace place;
        if (slave != file_.slaves.end()) {
            place.known = !slave->broken;
            const auto device = devices_of_.find(slave->slave.name);
            if (device != devices_of_.end()) place.device = &device->second;
            place.is_terminal = slave->terminal.has_value();
            const auto configured = std::ranges::find(out.machine.bus.slaves, slave->slave.name, &ecat::SlaveConfig::name);
            if (configured != out.machine.bus.slaves.end()) place.description = configured->device.get();
        }
        const auto device = std::ranges::find(out.machine.modbus, entry.point.slave, &modbus::tcp::DeviceConfig::name);
        if (slave == file_.slaves.end() && device != out.machine.modbus.end()) place.modbus = &*device;
        out.machine.io.push_back(make_point(reader_, entry, direction, place, out.machine.io));
        if (place.modbus && out.machine.io.back().index < device->channels.size()) use_channel(*device, out.machine.io.back());
    }

    /// A channel goes one way.
    void use_channel(modbus::tcp::DeviceConfig& device, const runtime::IoPoint& point) {
        using Use = modbus::tcp::Channel::Use;
        auto& channel = device.channels[point.index];
        const bool input = point.direction == runtime::IoDirection::input;
        if (!input && channel.use == Use::read)
            problem(fmt::format("io.outputs.{}.channel", point.name), "config.channel_taken",
                    fmt::format("register '{}' of '{}' is read as an input already", channel.name, device.name),
                    "name the same address a second time under `registers`, to read back what is written");
        channel.use = input ? Use::read : Use::written;
    }

    void add_program(LoadedMachine& out, const ProgramFile& entry) {
        auto program = entry.program;
        if (options_.resolve_programs && !program.library.empty()) resolve_library(program);
        for (const auto& t : entry.tasks) {
            auto task = t.task;
            task.program = program.name;
            task.divisor = static_cast<std::uint16_t>(t.every.time.count() > 0 ? t.every.time / out.machine.cycle
                                                                               : static_cast<std::int64_t>(t.every.cycles));
            out.machine.tasks.push_back(std::move(task));
        }
        if (entry.tasks.empty()) {
            runtime::TaskConfig task;
            task.name = "main";
            task.program = program.name;
            out.machine.tasks.push_back(std::move(task));
        }
        out.machine.programs.push_back(std::move(program));
    }

    /// What was read besides the machine file, each once.
    void list_files(LoadedMachine& out) {
        const auto add = [&](UsedFile::Kind kind, const std::string& written, const std::string& path) {
            const bool known = std::any_of(out.files.begin(), out.files.end(), [&](const UsedFile& file) {
                return file.kind == kind && file.written == written && file.path == path;
            });
            if (!known) out.files.push_back({kind, written, path});
        };
        for (const auto& path : drives_.files_read()) add(UsedFile::Kind::drive, fs::path(path).filename().string(), path);
        for (const auto& path : devices_.files_read()) add(UsedFile::Kind::device, fs::path(path).filename().string(), path);
        for (std::size_t i = 0; i < file_.programs.size() && i < out.machine.programs.size(); ++i)
            if (const auto& written = file_.programs[i].program.library; options_.resolve_programs && !written.empty())
                add(UsedFile::Kind::program, written, out.machine.programs[i].library);
        const auto beside = [&](const std::string& written) {
            return (fs::path(path_).parent_path() / written).lexically_normal().string();
        };
        for (const auto& entry : file_.cams)
            if (!entry.file.empty()) add(UsedFile::Kind::cam, entry.file, beside(entry.file));
        for (const auto& entry : file_.paths) {
            if (!entry.path.file.empty()) add(UsedFile::Kind::path, entry.path.file, beside(entry.path.file));
            if (!entry.tables.empty()) add(UsedFile::Kind::path, entry.tables, beside(entry.tables));
        }
        for (const auto& view : out.hmi.views)
            for (const auto& row : view.rows)
                for (const auto& widget : row)
                    if (!widget.image_path.empty()) add(UsedFile::Kind::image, widget.image, widget.image_path);
    }

    void resolve_library(runtime::ProgramConfig& program) {
        std::vector<std::string> searched;
        const auto try_path = [&](const fs::path& path) {
            std::error_code error;
            searched.push_back(path.lexically_normal().string());
            if (!fs::is_regular_file(path, error)) return false;
            program.library = searched.back();
            return true;
        };
        const fs::path written(program.library);
        if (written.is_absolute()) {
            if (try_path(written)) return;
        } else {
            if (try_path(fs::path(path_).parent_path() / written)) return;
            for (const auto& folder : options_.program_path)
                if (try_path(fs::path(folder) / written)) return;
        }
        problem(fmt::format("programs.{}.library", program.name), "config.no_library",
                fmt::format("there is no program library {}", names_or_none(searched)), "build the program, or correct the path");
    }

    /// Every simulated slave hangs behind one that stands before it on the cable, each socket has one cable.
    void check_wiring(const runtime::MachineConfig& machine) {
        std::vector<std::string> names;
        for (const auto& slave : machine.bus.slaves) names.push_back(slave.name);
        std::set<std::pair<std::string, unsigned>> taken;
        for (const auto& wire : machine.simulation.slaves) {
            const auto here = "simulation.slaves." + wire.slave;
            const auto self = std::find(names.begin(), names.end(), wire.slave);
            const auto report = [&](const std::string& name) {
                const auto near = nearest_name(name, names);
                problem(here, "simulation.unknown_slave", fmt::format("there is no slave '{}' (there is: {})", name, names_or_none(names)),
                        near.empty() ? "correct the name" : fmt::format("did you mean `{}`?", near));
            };
            if (self == names.end()) {
                report(wire.slave);
                continue;
            }
            if (wire.behind.empty()) continue;
            const auto parent = std::find(names.begin(), names.end(), wire.behind);
            if (parent == names.end()) {
                report(wire.behind);
            } else if (parent >= self) {
                problem(here, "simulation.order", fmt::format("'{}' stands behind '{}' in `bus.slaves`", wire.behind, wire.slave),
                        "list slaves in the order in which a frame reaches them");
            } else if (!taken.emplace(wire.behind, wire.port).second) {
                problem(here, "simulation.port_taken", fmt::format("port {} of '{}' has a cable already", wire.port, wire.behind),
                        "choose another port (1, 2, 3) or another slave");
            }
        }
    }

    /// runtime::check knows the targets too, but not which event it is.
    void check_events(const runtime::MachineConfig& machine) {
        using Kind = runtime::SimulationEvent::Kind;
        const auto groups = runtime::group_names(machine.bus);
        std::vector<std::string> inputs, slaves, axes, lines;
        for (const auto& line : machine.serial) lines.push_back(line.name);
        for (const auto& point : machine.io)
            if (point.direction == runtime::IoDirection::input) inputs.push_back(point.name);
        for (const auto& slave : machine.bus.slaves) slaves.push_back(slave.name);
        for (const auto& device : machine.modbus) slaves.push_back(device.name);
        for (const auto& binding : machine.axes) axes.push_back(binding.axis.name);
        for (std::size_t i = 0; i < machine.simulation.events.size(); ++i) {
            const auto& event = machine.simulation.events[i];
            const auto& known = event.kind == Kind::input || event.kind == Kind::input_fault ? inputs
                                : event.kind == Kind::slave_power                            ? slaves
                                : event.kind == Kind::serial_line                            ? lines
                                : event.kind == Kind::group                                  ? groups
                                                                                             : axes;
            if (event.target.empty() || std::find(known.begin(), known.end(), event.target) != known.end()) continue;
            const auto near = nearest_name(event.target, known);
            problem(fmt::format("simulation.events.{}", i), "simulation.unknown_target",
                    fmt::format("there is no {} '{}' (there is: {})",
                                event.kind == Kind::input || event.kind == Kind::input_fault ? "input"
                                : event.kind == Kind::slave_power                            ? "slave"
                                : event.kind == Kind::serial_line                            ? "serial line"
                                : event.kind == Kind::group                                  ? "group"
                                                                                             : "axis",
                                event.target, names_or_none(known)),
                    near.empty() ? "correct the name" : fmt::format("did you mean `{}`?", near));
        }
    }

    void add_warnings(LoadedMachine& out) {
        const auto warn = [&](const std::string& path, std::string code, std::string what, std::string remedy) {
            out.warnings.push_back({std::move(code), located(path_, reader_.find(path)), std::move(what), std::move(remedy)});
        };
        for (const auto& binding : out.machine.axes) {
            const auto& axis = binding.axis;
            const auto here = "axes." + axis.name;
            if (axis.disabled)
                warn(here + ".disabled", "config.axis_disabled", fmt::format("axis {} is left out", axis.name),
                     "remove `disabled` when it is commissioned");
            if (axis.simulated && !out.machine.bus.interface.empty())
                warn(here + ".simulated", "config.axis_simulated", fmt::format("axis {} is simulated on a real bus", axis.name),
                     "remove `simulated` when its drive is there");
            if (std::isinf(axis.following.window) && !axis.encoder && !(binding.slave.empty() && binding.drive.empty()))
                warn(here, "config.no_following_error", fmt::format("the following error of axis {} is not watched", axis.name),
                     "add `following_error: {window: ...}`");
        }
        if (out.hmi.lcm_commands == hmi::LcmCommands::local)
            warn("hmi.lcm.commands", "hmi.anybody_commands",
                 "every process of every user of this computer may move this machine: LCM knows no users and no passwords",
                 "set `commands: disabled` and use the local socket, whose group may command (`hmi.socket_group`)");
        if (const auto& served = out.hmi.modbus_server; served && reach_of(served->server.listen) != modbus::server::Reach::this_computer) {
            const auto writable = hmi::writable_count(*served);
            warn(
                "modbus_server.listen", "served.open",
                fmt::format("{} reads {} of this machine{}: Modbus knows no users and no passwords", hmi::reach_text(served->server.listen),
                            served->points.size() == 1 ? "a value" : fmt::format("{} values", served->points.size()),
                            writable > 0 ? fmt::format(" and may write {} of them", writable) : ""),
                "keep that network for machines alone, or listen at 127.0.0.1");
        }
    }

    void problem(const std::string& path, std::string code, std::string what, std::string remedy) {
        reader_.problem_in(path, std::move(code), std::move(what), std::move(remedy));
    }

    Reader& reader_;
    const std::string& path_;
    const LoadOptions& options_;
    MachineFile file_;
    std::size_t always_there_ = 0;  // slaves so far that are in no group: places on the cable count without those that may be away
    DriveLibrary drives_;
    DeviceLibrary devices_;
    std::map<std::string, LoadedDevice, std::less<>> devices_of_;  // by slave
    std::vector<std::pair<std::string, std::shared_ptr<const axes::DriveProfile>>> profiles_;
};

/// The floors name members of their structs; the file has friendlier keys in a few places.
std::string file_path_of(std::string subject) {
    if (subject == "lcm.rate") return "hmi.rate";
    if (subject == "socket" || subject.rfind("lcm.", 0) == 0) return "hmi." + subject;
    static constexpr std::pair<std::string_view, std::string_view> names[] = {
        {"axis_groups.", "groups."},
        {".following.", ".following_error."},
        {".windows.in_position_time", ".in_position.time"},
        {".windows.in_position", ".in_position.window"},
        {".windows.", ".in_position."},
        {".limits.position_min", ".limits.position"},
        {".limits.position_max", ".limits.position"},
        {".gearing.motor_revolutions", ".gearing.gear"},
        {".gearing.load_revolutions", ".gearing.gear"},
    };
    for (const auto& [member, key] : names)
        if (const auto at = subject.find(member); at != std::string::npos) subject.replace(at, member.size(), key);
    return subject;
}

void add_floor_errors(Reader& reader, const LoadedMachine& loaded) {
    for (auto& error : check_floors(loaded)) {
        if (error.subject.rfind(reader.file() + ":", 0) != 0) {  // else a start-up entry, which knows its place
            const auto path = file_path_of(error.subject);
            if (reader.already_bad(path)) continue;
            if (!error.subject.empty()) error.what = fmt::format("{}: {}", path, error.what);
            error.subject = located(reader.file(), reader.find(path));
        }
        reader.errors().push_back(std::move(error));
    }
}

/// What the programs have wrong is told in the same breath: nobody wants to mend a file twice. Names are compared with sections that were read
/// whole only.
void add_program_errors(Reader& reader, runtime::MachineConfig machine) {
    std::erase_if(machine.programs, [&](const auto& program) { return reader.already_bad("programs." + program.name); });
    for (auto& error : runtime::check_programs(machine)) {
        const std::string_view section = error.code == "program.unknown_axis"                                              ? "axes"
                                         : error.code == "program.unknown_device"                                          ? "bus"
                                         : error.code == "program.unknown_cam"                                             ? "cams"
                                         : error.code == "program.unknown_input" || error.code == "program.unknown_output" ? "io"
                                                                                                                           : "";
        if (section.empty() || !reader.already_bad(section)) reader.errors().push_back(std::move(error));
    }
}

/// By file, line and column; the machine's own file first.
void sort_errors(std::vector<Error>& errors, const std::string& first_file) {
    const auto key = [&](const Error& error) {
        std::string file = error.subject;
        int numbers[2] = {0, 0};
        for (int n = 1; n >= 0; --n) {
            const auto colon = file.find_last_of(':');
            if (colon == std::string::npos || colon + 1 == file.size() ||
                file.find_first_not_of("0123456789", colon + 1) != std::string::npos || file.size() - colon > 9)
                break;
            numbers[n] = std::stoi(file.substr(colon + 1));
            file.resize(colon);
        }
        return std::tuple{file != first_file, file, numbers[0], numbers[1]};
    };
    std::stable_sort(errors.begin(), errors.end(), [&](const Error& a, const Error& b) { return key(a) < key(b); });
}

LoadResult load(const std::string& path, Document document, const LoadOptions& options) {
    if (document.root.kind == Node::Kind::null) return std::move(document.errors);
    Reader reader(path);
    reader.errors() = std::move(document.errors);
    MachineFile file;
    read_table(reader, document.root, machine_table(), file);
    auto loaded = Assembly(reader, path, options, std::move(file)).assemble();
    add_floor_errors(reader, loaded);
    if (reader.errors().empty()) return loaded;
    sort_errors(reader.errors(), path);
    if (options.resolve_programs) add_program_errors(reader, std::move(loaded.machine));
    return std::move(reader.errors());
}

}  // namespace

namespace {

std::vector<std::string> data_folders(const char* kind, std::vector<std::string> first, const std::string& machine_file,
                                      const LoadOptions& options) {
    auto folders = std::move(first);
    folders.push_back((fs::path(machine_file).parent_path() / ".." / kind).lexically_normal().string());
    for (const auto& data : options.data_dirs) folders.push_back((fs::path(data) / kind).lexically_normal().string());
#ifdef TAKTWERK_DATA_DIR
    folders.push_back((fs::path(TAKTWERK_DATA_DIR) / kind).string());
#endif
    return folders;
}

}  // namespace

std::vector<std::string> drive_folders(const std::string& machine_file, const LoadOptions& options) {
    return data_folders("drives", options.drive_dirs, machine_file, options);
}

std::vector<std::string> device_folders(const std::string& machine_file, const LoadOptions& options) {
    return data_folders("devices", options.device_dirs, machine_file, options);
}

LoadResult load_machine(const std::string& path, const LoadOptions& options) { return load(path, read_document(path), options); }

LoadResult load_machine_text(const std::string& path, std::string_view text, const LoadOptions& options) {
    return load(path, parse_document(path, text), options);
}

}  // namespace taktwerk::config
