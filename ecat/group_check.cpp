#include "ecat/group_check.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace taktwerk::ecat {

namespace {

class Groups {
public:
    Groups(const BusConfig& config, std::vector<Error>& errors) : config_(config), errors_(errors) {}

    void check() {
        const auto groups = hot_connect_groups(config_);
        if (groups.empty()) return;
        check_bus();
        for (const auto& group : groups) check_group(group);
    }

private:
    void add(std::string subject, std::string what, std::string remedy) {
        errors_.push_back({"bus.hot_connect", std::move(subject), std::move(what), std::move(remedy)});
    }
    static std::string subject_of(const SlaveConfig& slave) { return fmt::format("slave '{}'", slave.name); }

    void check_bus() {
        if (config_.ring)
            add("bus", "a ring cannot have groups that come and go: a plug that is pulled out of a ring is a break of its cable",
                "remove `ring`, or the `hot_connect` of all slaves");
        const bool somebody_stays = std::any_of(config_.slaves.begin(), config_.slaves.end(), [](const auto& s) { return !s.guest(); });
        if (!somebody_stays)
            add("bus", "all slaves belong to groups that come and go: nobody is left whom they could be plugged into",
                "leave out `hot_connect` at those that are always there");
        const auto synchronised = [](bool guest) {
            return [guest](const SlaveConfig& slave) { return slave.guest() == guest && slave.dc; };
        };
        const auto guest = std::find_if(config_.slaves.begin(), config_.slaves.end(), synchronised(true));
        if (guest == config_.slaves.end() || std::any_of(config_.slaves.begin(), config_.slaves.end(), synchronised(false))) return;
        add(subject_of(*guest), "it runs SYNC0, and so does nobody who is always there: the reference clock would come and go with it",
            "put a slave that runs SYNC0 (`dc: true`) in front of it on the bus, or set `dc: false`");
    }

    void check_group(const HotConnectGroup& group) {
        const auto& head = config_.slaves[group.slaves.front()];
        if (head.position)
            add(subject_of(head),
                fmt::format("it stands first in group '{}', which may be plugged in anywhere, and has a position", group.name),
                "give it an `alias` (written by `taktwerk bus eeprom alias`) or a `device_id` (its switches) instead");
        else if (head.alias.has_value() == head.device_id.has_value())
            add(subject_of(head),
                fmt::format("it stands first in group '{}' and has {}: nobody would know it", group.name,
                            head.alias ? "both an alias and a device id" : "neither an alias nor a device id"),
                "give it exactly one of them");
        for (std::size_t n = 0; n < group.slaves.size(); ++n) {
            const auto& slave = config_.slaves[group.slaves[n]];
            if (n > 0) check_follower(group, n);
            check_description(slave);
            check_unit(group, slave);
        }
    }

    void check_follower(const HotConnectGroup& group, std::size_t n) {
        const auto& slave = config_.slaves[group.slaves[n]];
        if (slave.position || slave.alias || slave.device_id)
            add(subject_of(slave),
                fmt::format("it follows '{}' in group '{}' and has a place of its own", config_.slaves[group.slaves[n - 1]].name,
                            group.name),
                "leave out its position, alias or device id; or give it a group of its own");
        if (group.slaves[n] != group.slaves[n - 1] + 1)
            add(subject_of(slave),
                fmt::format("between it and '{}', which it follows in group '{}', others are listed",
                            config_.slaves[group.slaves[n - 1]].name, group.name),
                "list the slaves of a group one behind the other, as they stand on the cable");
    }

    /// Its place in the process image is laid out while it is away.
    void check_description(const SlaveConfig& slave) {
        if (!slave.device) return;
        const auto& stated = slave.device->stated;
        if (stated.identity && stated.process_data) return;
        add(subject_of(slave),
            fmt::format("it may be away when the bus starts, and '{}' does not say {}", slave.device->name,
                        stated.identity ? "which process data it has" : "how it identifies itself"),
            "describe it: import its ESI file (`taktwerk esi import`), or a drive file");
    }

    void check_unit(const HotConnectGroup& group, const SlaveConfig& slave) {
        if (slave.sync_unit.empty()) return;
        const auto other = std::find_if(config_.slaves.begin(), config_.slaves.end(), [&](const SlaveConfig& one) {
            return one.sync_unit == slave.sync_unit && one.hot_connect != group.name;
        });
        if (other != config_.slaves.end())
            add(subject_of(slave),
                fmt::format(
                    "it shares the sync unit '{}' with '{}', which is not in group '{}': without the group neither would be exchanged",
                    slave.sync_unit, other->name, group.name),
                "give the group a sync unit of its own");
    }

    const BusConfig& config_;
    std::vector<Error>& errors_;
};

}  // namespace

void check_groups(const BusConfig& config, std::vector<Error>& errors) { Groups{config, errors}.check(); }

}  // namespace taktwerk::ecat
