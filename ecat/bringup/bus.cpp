#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

namespace {

Script<void> keep_error(Bus& bus, BusSlave& slave, SlaveStep step, std::optional<Error>& error) {
    const Result<void> result = co_await step(bus, slave);
    if (!result) error = result.error();
}

}  // namespace

Script<Result<void>> for_each_slave(Bus& bus, SlaveStep step) {
    std::vector<std::optional<Error>> errors(bus.slaves.size());
    std::vector<Script<void>> scripts;
    for (std::size_t i = 0; i < bus.slaves.size(); ++i)
        if (!bus.slaves[i]->away()) scripts.push_back(keep_error(bus, *bus.slaves[i], step, errors[i]));
    co_await all(std::move(scripts), DatagramPort::slaves_at_once);
    for (const auto& error : errors)
        if (error) co_return *error;
    co_return Result<void>{};
}

}  // namespace taktwerk::ecat
