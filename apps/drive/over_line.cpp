#include "apps/drive/over_line.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "apps/drive/line_session.hpp"
#include "apps/drive/profiles.hpp"
#include "apps/machine/load.hpp"
#include "apps/machine/stop_signal.hpp"
#include "apps/terminal/exit_code.hpp"
#include "axes/drives/xp200/drive_config.hpp"
#include "axes/drives/xp200/registers.hpp"
#include "axes/port/parameter_text.hpp"

namespace taktwerk::apps {

namespace {

using namespace std::chrono_literals;
namespace pr = axes::xp200::pr;
namespace status = axes::xp200::status;
using axes::xp200::ConductingReads;

constexpr const char* plain_profile = "xp200";  // the one kind of drive that a line carries

/// A drive on a line, and the line.
struct Place {
    std::string name, line, device;
    std::size_t index = 0;  ///< of the line in the machine
    modbus::LineSettings settings;
    std::uint8_t station = 1;
    ConductingReads outputs = ConductingReads::zero;
    std::shared_ptr<const axes::DriveProfile> profile;
};

std::vector<Place> places_of(const runtime::MachineConfig& machine) {
    std::vector<Place> out;
    for (std::size_t i = 0; i < machine.serial.size(); ++i)
        for (const auto& entry : machine.serial[i].drives) {
            const auto& line = machine.serial[i];
            const auto& drive = entry.drive;
            out.push_back({drive.name, line.name, line.device, i, line.settings, drive.station, drive.outputs, drive.profile});
        }
    return out;
}

/// "8E1" as Pr183 has it.
Result<modbus::LineSettings> settings_of(const DriveOptions& options) {
    modbus::LineSettings settings;
    settings.baud = options.baud;
    const auto& f = options.format;
    const bool whole = f.size() == 3 && f[0] == '8' && (f[1] == 'N' || f[1] == 'E' || f[1] == 'O') && (f[2] == '1' || f[2] == '2');
    if (!whole)
        return Error{"drive.value", "--format " + f, "is no format of a character", "write 8N1, 8E1, 8O1, 8N2, 8E2 or 8O2, as Pr183 says"};
    settings.parity = f[1] == 'N' ? modbus::Parity::none : f[1] == 'E' ? modbus::Parity::even : modbus::Parity::odd;
    settings.stop_bits = static_cast<std::uint8_t>(f[2] - '0');
    return settings;
}

/// --line: DRIVE is a station there.
Result<Place> place_by_hand(const DriveOptions& options) {
    Place place;
    int station = 0;
    const auto& word = options.drive;
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), station);
    if (problem != std::errc{} || end != word.data() + word.size() || station < 1 || station > 247)
        return Error{"drive.value", "drive " + word, "is no station of a serial line", "with --line give its number, 1 to 247 (Pr181)"};
    const auto settings = settings_of(options);
    if (!settings) return settings.error();
    const auto profile = profile_named(options, options.profile.empty() ? plain_profile : options.profile);
    if (!profile) return profile.error();
    place.name = word;
    place.device = options.line;
    place.settings = *settings;
    place.station = static_cast<std::uint8_t>(station);
    place.profile = *profile;
    return place;
}

Result<std::unique_ptr<LineSession>> session_of(const Place& place, const runtime::MachineConfig* simulated) {
    if (simulated != nullptr) return LineSession::simulate(*simulated, place.index);
    return LineSession::open(place.device, place.settings);
}

class DriveOverLine final : public DriveAccess {
public:
    DriveOverLine(LineSession& session, const Place& place, std::string where)
        : DriveAccess(place.profile), session_(session), place_(place), where_(std::move(where)) {}

    [[nodiscard]] std::string subject() const override {
        return fmt::format("drive '{}' ({}), station {}", place_.name, profile().name, place_.station);
    }
    [[nodiscard]] std::string word() const override { return place_.name; }
    [[nodiscard]] std::string where() const override { return where_; }

    [[nodiscard]] Result<std::vector<std::byte>> read_bytes(const axes::DriveParameter& parameter) override {
        const auto words = ask(modbus::read_parameters(place_.station, parameter.address.index, 1));
        if (!words) return words.error();
        const auto word = words->front();
        return std::vector<std::byte>{static_cast<std::byte>(word & 0xFF), static_cast<std::byte>(word >> 8)};
    }
    [[nodiscard]] Result<void> write_bytes(const axes::DriveParameter& parameter, std::vector<std::byte> value, Storing) override;
    [[nodiscard]] Result<void> store_all() override;
    [[nodiscard]] bool guards(const axes::DriveParameter& parameter) const override;
    [[nodiscard]] Result<DriveComplaint> complaint() override;
    [[nodiscard]] Result<bool> reset_fault(Duration patience) override;
    void wait(Duration time) override { (void)session_.wait(time); }  // interrupted: the next access says so
    void finish_undisturbed() override { session_.finish_undisturbed(); }

    /// Drive code, motor code and software version, as it says them (5.4.1 Pr001 to Pr003); what they mean the manual does not say.
    [[nodiscard]] Result<std::string> identity() {
        const auto words = ask(modbus::read_parameters(place_.station, 1, 3));
        if (!words) return words.error();
        return fmt::format("drive code {}, motor code {}, software {}", (*words)[0], (*words)[1], (*words)[2]);
    }

private:
    [[nodiscard]] Result<std::vector<std::uint16_t>> ask(const modbus::Request& request);
    [[nodiscard]] Result<bool> enabled();
    [[nodiscard]] Error refused(std::string what, std::string remedy) const {
        return {"drive.not_taken", subject(), std::move(what), std::move(remedy)};
    }

    LineSession& session_;
    const Place& place_;
    std::string where_;
};

Result<std::vector<std::uint16_t>> DriveOverLine::ask(const modbus::Request& request) {
    const auto answer = session_.ask(request);
    if (!answer) return answer.error();
    switch (answer->outcome) {
        case modbus::Outcome::answered: break;
        case modbus::Outcome::exception:
            return refused(fmt::format("register {}: {}", request.address, modbus::name(answer->response.exception)),
                           "check number and range in the drive's table (`taktwerk drive params`)");
        default:
            return Error{
                "serial.silent", subject(), fmt::format("{} at {} baud on {}", modbus::name(answer->outcome), place_.settings.baud, where_),
                "check mains and cable, and Pr181 (station), Pr182 (baud), Pr183 (format) at the panel: they count after saving and "
                "a restart, and -1 in Pr181 closes the port"};
    }
    const auto values = answer->response.values();
    return std::vector<std::uint16_t>(values.begin(), values.end());
}

/// What forces an input on, or enables: for whoever stands beside the motor, at its panel.
bool DriveOverLine::guards(const axes::DriveParameter& parameter) const {
    const auto number = parameter.address.index;
    return number == pr::forced_enable || (number >= pr::force_1 && number <= pr::force_5);
}

Result<void> DriveOverLine::write_bytes(const axes::DriveParameter& parameter, std::vector<std::byte> value, Storing) {
    const auto word = static_cast<std::uint16_t>(std::to_integer<unsigned>(value[0]) | (std::to_integer<unsigned>(value[1]) << 8));
    if (guards(parameter) && word != 0)
        return refused(fmt::format("{} forces the drive's inputs: it could enable or move the motor, or defeat its limit switches",
                                   axes::name_of(parameter)),
                       "0 is taken; anything else only at the panel [5.4.2]");
    const auto done = ask(modbus::write_parameter(place_.station, parameter.address.index, word));
    if (!done) return done.error();
    return {};
}

/// By RUN, on whichever output shows it (5.3); there is no status word. Error: none does.
Result<bool> DriveOverLine::enabled() {
    const auto functions = ask(modbus::read_parameters(place_.station, pr::output_function, axes::xp200::output_count));
    if (!functions) return functions.error();
    const auto outputs = ask(modbus::read_status(place_.station, status::outputs, 1));
    if (!outputs) return outputs.error();
    for (int i = 0; i < axes::xp200::output_count; ++i) {
        const auto function = static_cast<std::int16_t>((*functions)[static_cast<std::size_t>(i)]);
        if (std::abs(function) != static_cast<int>(axes::xp200::Output::running)) continue;
        const bool conducts = ((outputs->front() >> i) & 1) == (place_.outputs == ConductingReads::one ? 1 : 0);
        return conducts == (function > 0);
    }
    return Error{"drive.cannot_store", subject(), "no output shows RUN, so nobody knows whether it is enabled",
                 "give one of Pr108 to Pr111 the function 9 [5.3], or store at the panel (E-SEt)"};
}

/// 9.6.6: the whole table, forced inputs and Pr098 too; what is stored there enables or moves at the next power-on.
Result<void> DriveOverLine::store_all() {
    const auto runs = enabled();
    if (!runs) return runs.error();
    if (*runs)
        return Error{"drive.cannot_store", subject(), "it is enabled", "disable it first: storing takes 5 s, in which it hears nothing"};
    const auto forced = ask(modbus::read_parameters(place_.station, pr::force_1, 5));
    if (!forced) return forced.error();
    const auto enable = ask(modbus::read_parameters(place_.station, pr::forced_enable, 1));
    if (!enable) return enable.error();
    bool harmless = enable->front() == 0;
    for (const auto word : *forced) harmless = harmless && word == 0;
    if (!harmless)
        return Error{"drive.cannot_store", subject(),
                     "Pr098 or one of Pr120 to Pr124 is not 0: stored, it would force the drive on at each power-on",
                     "set them to 0 first"};
    const auto done = ask(modbus::save(place_.station));
    if (!done) return done.error();
    if (!session_.wait(std::chrono::seconds{modbus::save_seconds}))
        return Error{"bus.interrupted", subject(), "ended while the drive stores", "leave its mains on for 5 s: else alarm 20 [6.1]"};
    return {};
}

Result<DriveComplaint> DriveOverLine::complaint() {
    const auto alarm = ask(modbus::read_status(place_.station, status::alarm, 1));
    if (!alarm) return alarm.error();
    const bool none = alarm->front() == 0xFF || alarm->front() == 0xFFFF;  // the register's coding is not stated (9.5)
    return DriveComplaint{none ? std::uint16_t{0} : alarm->front(), std::nullopt};
}

/// Nothing selected, disabled, then 43h: whether clearing with an enable still there starts the motor is not stated (4.7).
Result<bool> DriveOverLine::reset_fault(Duration patience) {
    for (const auto& request : {modbus::write_parameter(place_.station, pr::force_3, 0), modbus::servo(place_.station, modbus::servo_off),
                                modbus::clear_alarm(place_.station)})
        if (const auto done = ask(request); !done) return done.error();
    for (const auto end = session_.now() + patience; session_.now() < end;) {
        const auto now = complaint();
        if (!now) return now.error();
        if (now->code == 0) return true;
        if (!session_.wait(100ms)) break;
    }
    return false;
}

std::string where_of(const Place& place, const runtime::MachineConfig* simulated) {
    if (simulated != nullptr) return fmt::format("simulated line '{}' of '{}'", place.line, simulated->name);
    return place.line.empty() ? place.device : fmt::format("line '{}' ({})", place.line, place.device);
}

/// `work` gets the place and, where it is simulated, the machine. Errors are returned.
Result<void> for_places(const DriveOptions& options, const std::function<Result<void>(const Place&, const runtime::MachineConfig*)>& work) {
    if (!options.line.empty()) {
        const auto place = place_by_hand(options);
        return place ? work(*place, nullptr) : Result<void>(place.error());
    }
    auto result = read_machine_without_programs(options.bus->machine, options.bus->simulate);
    const auto* loaded = std::get_if<LoadedFile>(&result);
    if (loaded == nullptr) return std::get<1>(result).front();
    for (auto& place : places_of(loaded->machine)) {
        if (!options.drive.empty() && options.drive != place.name) continue;
        if (!options.profile.empty()) {
            const auto named = profile_named(options, options.profile);
            if (!named) return named.error();
            place.profile = *named;
        }
        if (auto done = work(place, options.bus->simulate ? &loaded->machine : nullptr); !done) return done;
    }
    return {};
}

}  // namespace

bool is_on_line(const DriveOptions& options) {
    if (!options.line.empty()) return true;
    if (options.drive.empty()) return false;
    const auto names = drives_on_lines(options);
    return std::find(names.begin(), names.end(), options.drive) != names.end();
}

std::vector<std::string> drives_on_lines(const DriveOptions& options) {
    std::vector<std::string> out;
    if (options.bus->machine.empty()) return out;
    const auto result = read_machine_without_programs(options.bus->machine, options.bus->simulate);
    if (const auto* loaded = std::get_if<LoadedFile>(&result))
        for (const auto& place : places_of(loaded->machine)) out.push_back(place.name);
    return out;
}

int with_drive_over_line(const DriveOptions& options, const std::function<int(DriveAccess&)>& work) {
    watch_stop_signals();
    int code = exit_ok;
    const auto done = for_places(options, [&](const Place& place, const runtime::MachineConfig* simulated) -> Result<void> {
        const auto session = session_of(place, simulated);
        if (!session) return session.error();
        DriveOverLine access(**session, place, where_of(place, simulated));
        code = work(access);
        return {};
    });
    return done ? code : fail(*options.bus, done.error());
}

Result<std::vector<LineDrive>> identify_on_lines(const DriveOptions& options) {
    std::vector<LineDrive> out;
    const auto done = for_places(options, [&](const Place& place, const runtime::MachineConfig* simulated) -> Result<void> {
        const auto session = session_of(place, simulated);
        if (!session) return session.error();
        DriveOverLine access(**session, place, where_of(place, simulated));
        const auto says = access.identity();
        out.push_back({fmt::format("{} on {}", access.subject(), access.where()), says ? *says : says.error().what, place.profile->name});
        return {};
    });
    if (!done) return done.error();
    return out;
}

}  // namespace taktwerk::apps
