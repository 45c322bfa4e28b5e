#include "apps/drive/in_machine.hpp"

#include <algorithm>
#include <charconv>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/drive/profiles.hpp"
#include "apps/machine/remote.hpp"
#include "apps/machine/stop_signal.hpp"
#include "axes/port/parameter_text.hpp"
#include "core/clock.hpp"
#include "hmi_bridge/gateway/drive_requests.hpp"

namespace taktwerk::apps {

namespace {

using namespace std::chrono_literals;

constexpr Duration between_looks = 50ms;

class DriveInMachine final : public DriveAccess {
public:
    DriveInMachine(hmi::Client& client, std::string machine, MachineDrive drive, std::shared_ptr<const axes::DriveProfile> profile)
        : DriveAccess(std::move(profile)), client_(client), machine_(std::move(machine)), drive_(std::move(drive)) {}

    [[nodiscard]] std::string subject() const override {
        const auto one_of = profile().axes > 1 ? fmt::format(", axis {} of {}", drive_.drive_axis, profile().axes) : std::string{};
        return fmt::format("axis {} ({} '{}'{})", drive_.axis, profile().name, drive_.drive, one_of);
    }
    [[nodiscard]] std::string word() const override { return drive_.axis; }
    [[nodiscard]] std::string where() const override { return fmt::format("machine '{}'", machine_); }

    [[nodiscard]] Result<std::vector<std::byte>> read_bytes(const axes::DriveParameter& parameter) override {
        const auto answer = ask({{"cmd", "drive_read"}, {"axis", drive_.axis}, {"parameter", axes::name_of(parameter)}});
        if (!answer) return answer.error();
        std::vector<std::byte> bytes;
        if (const auto list = answer->find("bytes"); list != answer->end() && list->is_array())
            for (const auto& byte : *list) bytes.push_back(static_cast<std::byte>(byte.get<unsigned>()));
        return bytes;
    }
    [[nodiscard]] Result<void> write_bytes(const axes::DriveParameter& parameter, std::vector<std::byte> value, Storing storing) override {
        const auto raw = axes::from_bytes(parameter, value);
        if (!raw) return raw.error();
        const auto answer = ask({{"cmd", "drive_write"},
                                 {"axis", drive_.axis},
                                 {"parameter", axes::name_of(parameter)},
                                 {"value", axes::value_text(parameter, *raw)},
                                 {"store", storing == Storing::asked}});
        if (!answer) return answer.error();
        return {};
    }
    [[nodiscard]] Result<void> store_all() override {
        const auto answer = ask({{"cmd", "drive_store"}, {"axis", drive_.axis}}, hmi::DriveRequests::store_patience + 1s);
        if (!answer) return answer.error();
        return {};
    }
    [[nodiscard]] Result<void> clear_turns() override {
        const auto answer = ask({{"cmd", "drive_clear_turns"}, {"axis", drive_.axis}});
        if (!answer) return answer.error();
        return {};
    }
    [[nodiscard]] Result<DriveComplaint> complaint() override;
    [[nodiscard]] Result<bool> reset_fault(Duration patience) override;
    void wait(Duration time) override {
        for (const auto end = clock_.now() + time; clock_.now() < end && !interrupted();) std::this_thread::sleep_for(between_looks);
    }
    void finish_undisturbed() override { undisturbed_ = true; }

private:
    [[nodiscard]] bool interrupted() const noexcept { return stop_requested() && !undisturbed_; }
    [[nodiscard]] Result<Json> ask(nlohmann::json request, Duration patience = hmi::Client::patience) {
        if (interrupted()) return Error{"bus.interrupted", "", "ended before it was done", ""};
        return client_.request(std::move(request), patience);
    }
    /// The machine's state of this axis.
    [[nodiscard]] Result<Json> axis_state() {
        const auto state = state_of(client_);
        if (!state) return state.error();
        for (const auto& axis : state->at("axes"))
            if (axis.at("name") == drive_.axis) return axis;
        return Error{"drive.no_drive", drive_.axis, "the machine shows no such axis any more", "Look at `taktwerk monitor`."};
    }

    hmi::Client& client_;
    std::string machine_;
    MachineDrive drive_;
    SystemClock clock_;
    bool undisturbed_ = false;
};

Result<DriveComplaint> DriveInMachine::complaint() {
    const auto axis = axis_state();
    if (!axis) return axis.error();
    DriveComplaint out;
    out.code = axis->at("drive_error").get<std::uint16_t>();
    if (out.code == 0 || profile().alarm_detail_index == 0) return out;
    for (const auto& parameter : profile().parameters) {
        if (parameter.address != axes::ParameterAddress{profile().alarm_detail_index, profile().alarm_detail_sub}) continue;
        if (const auto detail = read(parameter)) out.detail = static_cast<std::uint32_t>(*detail);
        break;
    }
    return out;
}

Result<bool> DriveInMachine::reset_fault(Duration patience) {
    if (const auto asked = ask({{"cmd", "reset"}, {"axis", drive_.axis}}); !asked) return asked.error();
    const auto end = clock_.now() + patience;
    do {
        wait(between_looks);  // the snapshot that still shows the axis as it was before must not count
        const auto axis = axis_state();
        if (!axis) return axis.error();
        if (!axis->at("resetting").get<bool>() && axis->at("state") != "ErrorStop") return true;
    } while (clock_.now() < end && !interrupted());
    return false;
}

Result<hmi::Client> connect(const std::string& socket) {
    auto client = hmi::Client::connect(socket);
    if (client || client.error().code != "socket.not_found" || !socket.empty()) return client;
    auto error = client.error();
    error.what += ", and no bus was named";
    error.remedy = "start the machine (taktwerk run FILE), or say which bus: --nic INTERFACE, or --machine FILE";
    return error;
}

Result<MachineDrives> drives_of_machine(hmi::Client& client) {
    const auto layout = layout_of(client);
    if (!layout) return layout.error();
    MachineDrives out;
    const auto read = understood(client.path(), [&] {
        out.machine = layout->at("machine").get<std::string>();
        out.slaves = layout->at("slaves").get<std::vector<std::string>>();
        for (const auto& axis : layout->at("axes"))
            if (const auto drive = axis.value("drive", ""); !drive.empty())
                out.drives.push_back({axis.at("name").get<std::string>(), drive, axis.value("profile", ""), axis.value("drive_axis", 1)});
        return 0;
    });
    if (!read) return read.error();
    return out;
}

}  // namespace

Result<MachineDrives> drives_of_machine(const std::string& socket) {
    auto client = connect(socket);
    if (!client) return client.error();
    return drives_of_machine(*client);
}

Result<MachineDrive> find_drive(const MachineDrives& machine, const std::string& word, int axis) {
    for (const auto& drive : machine.drives)
        if (drive.axis == word) return drive;
    auto wanted = word;
    std::size_t position = 0;
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), position);
    if (problem == std::errc{} && end == word.data() + word.size() && position < machine.slaves.size()) wanted = machine.slaves[position];
    std::vector<std::string> names;
    int axes_there = 0;
    for (const auto& drive : machine.drives) {
        if (drive.drive == wanted && drive.drive_axis == axis) return drive;
        axes_there += drive.drive == wanted ? 1 : 0;
        names.push_back(fmt::format("{} (axis {})", drive.drive, drive.axis));
    }
    if (axes_there > 0)
        return Error{"drive.no_drive", word, fmt::format("no axis of the machine is axis {} of this drive", axis),
                     "leave --axis away, or name the machine's axis instead of the drive"};
    return Error{"drive.no_drive", word, fmt::format("machine '{}' has no such drive", machine.machine),
                 names.empty() ? "it has no drives at all" : fmt::format("it has: {}", fmt::join(names, ", "))};
}

int with_drive_in_machine(const DriveOptions& options, const std::function<int(DriveAccess&)>& work) {
    const auto refuse = [&](const Error& error) { return fail(*options.bus, error); };
    watch_stop_signals();
    auto client = connect(options.socket);
    if (!client) return refuse(client.error());
    const auto machine = drives_of_machine(*client);
    if (!machine) return refuse(machine.error());
    const auto drive = find_drive(*machine, options.drive, options.axis);
    if (!drive) return refuse(drive.error());
    const auto profile = profile_named(options, options.profile.empty() ? drive->profile : options.profile);
    if (!profile) return refuse(profile.error());
    DriveInMachine access(*client, machine->machine, *drive, *profile);
    const auto code = understood(client->path(), [&] { return work(access); });
    return code ? *code : refuse(code.error());
}

}  // namespace taktwerk::apps
