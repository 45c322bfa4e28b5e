#include "ecat/place_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace taktwerk::ecat {

namespace {

constexpr std::uint16_t maximum_divisor = 1000;
constexpr std::uint16_t most_slaves = 4096;  ///< station addresses 1001h .. 2000h

std::string subject_of(const SlaveConfig& slave) { return fmt::format("slave '{}'", slave.name); }

class Places {
public:
    Places(const BusConfig& config, std::vector<Error>& errors) : config_(config), errors_(errors) {}

    void check() {
        for (const auto& slave : config_.slaves) {
            check_name(slave);
            check_count(slave);
            check_position(slave);
            check_number(slave, slave.alias, aliases_, "alias");
            check_number(slave, slave.device_id, device_ids_, "device id");
        }
        check_units();
    }

private:
    void add(std::string code, std::string subject, std::string what, std::string remedy) {
        errors_.push_back({std::move(code), std::move(subject), std::move(what), std::move(remedy)});
    }

    void check_name(const SlaveConfig& slave) {
        if (slave.name.empty()) add("bus.no_name", "bus", "a slave has no name", "give every slave a name");
        else if (!names_.insert(slave.name).second)
            add("bus.duplicate_name", subject_of(slave), "two slaves have this name", "choose different names");
    }

    void check_count(const SlaveConfig& slave) {
        if (slave.guest()) return;  // group_check.hpp
        const int places = slave.position.has_value() + slave.alias.has_value() + slave.device_id.has_value();
        if (places != 1)
            add("bus.place", subject_of(slave),
                places == 0 ? "it has neither a position nor an alias nor a device id"
                            : "it has more than one of position, alias and device id",
                "give exactly one of them");
    }

    void check_position(const SlaveConfig& slave) {
        if (!slave.position || slave.guest()) return;  // of a group: group_check.hpp
        if (!positions_.insert(*slave.position).second)
            add("bus.duplicate_position", subject_of(slave), fmt::format("position {} is taken by another slave", *slave.position),
                "positions count from 0 along the cable");
        const bool all_listed = config_.extra_slaves == ExtraSlaves::refuse;
        const auto residents = static_cast<std::size_t>(
            std::count_if(config_.slaves.begin(), config_.slaves.end(), [](const SlaveConfig& one) { return !one.guest(); }));
        const std::size_t limit = all_listed ? residents : most_slaves;
        if (*slave.position >= limit)
            add("bus.position", subject_of(slave), fmt::format("position {} on a bus of {} slaves", *slave.position, limit),
                all_listed ? "positions count from 0 along the cable, and every slave is listed; or set `extra_slaves: ignore`"
                           : "positions count from 0 along the cable");
    }

    void check_number(const SlaveConfig& slave, const std::optional<std::uint16_t>& number, std::set<std::uint16_t>& taken,
                      const std::string& what) {
        if (!number) return;
        const std::string code = what == "alias" ? "alias" : "device_id";
        if (*number == 0)
            add("bus." + code, subject_of(slave), fmt::format("{} 0 means that none is set", what),
                fmt::format("set one in the drive, or use the position"));
        else if (!taken.insert(*number).second)
            add("bus.duplicate_" + code, subject_of(slave), fmt::format("{} {} is taken by another slave", what, *number),
                "they are unique on a bus");
    }

    void check_units() {
        std::set<std::string> listed;
        for (const auto& unit : config_.sync_units) {
            const std::string subject = fmt::format("sync unit '{}'", unit.name);
            if (!listed.insert(unit.name).second) add("bus.duplicate_sync_unit", subject, "it is listed twice", "keep one of them");
            if (unit.divisor == 0 || unit.divisor > maximum_divisor)
                add("bus.sync_unit_divisor", subject, fmt::format("it cannot be exchanged every {} cycles", unit.divisor),
                    fmt::format("1 .. {}", maximum_divisor));
            const bool used = std::any_of(config_.slaves.begin(), config_.slaves.end(),
                                          [&](const SlaveConfig& slave) { return slave.sync_unit == unit.name; });
            if (!used)
                add("bus.sync_unit_unused", subject, "no slave belongs to it",
                    "name it as `sync_unit` of its slaves, or remove it from the list");
        }
    }

    const BusConfig& config_;
    std::vector<Error>& errors_;
    std::set<std::string> names_;
    std::set<std::uint16_t> positions_, aliases_, device_ids_;
};

}  // namespace

void check_places(const BusConfig& config, std::vector<Error>& errors) { Places{config, errors}.check(); }

}  // namespace taktwerk::ecat
