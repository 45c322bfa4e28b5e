#include "ecat/diagnosis/physical_remarks.hpp"

#include <fmt/format.h>

#include "ecat/diagnosis/phy_report.hpp"

namespace taktwerk::ecat {

namespace {

Script<void> ask_phys(DatagramPort& port, const SurveyedSlave& slave, std::string subject, std::vector<Error>& wrong) {
    const Result<std::vector<PhyReport>> reports = co_await read_phys(port, slave, std::nullopt, subject);
    if (!reports) co_return;
    for (const auto& report : *reports)
        if (auto trouble = phy_trouble(report, subject)) wrong.push_back(std::move(*trouble));
}

}  // namespace

std::vector<Error> ebus_overloads(const Survey& survey) {
    std::vector<Error> found;
    std::size_t feeder = 0;
    bool told = false;
    for (std::size_t at = 0; at < survey.slaves.size(); ++at) {
        const auto& slave = survey.slaves[at];
        if (slave.ebus_current.value_or(0) < 0) feeder = at, told = false;
        if (told || slave.ebus_left.value_or(0) >= 0) continue;
        told = true;
        const int supplied = -survey.slaves[feeder].ebus_current.value_or(0);
        found.push_back({"bus.ebus_overload", survey.subject(at),
                         fmt::format("up to here the terminals take {} mA from the E-bus, and {} supplies {} mA",
                                     supplied - *slave.ebus_left, survey.subject(feeder), supplied),
                         "put a feed terminal before it, such as EL9410, or a coupler of its own"});
    }
    return found;
}

Script<Result<std::vector<Error>>> wrong_links(DatagramPort& port, const Survey& survey) {
    std::vector<std::vector<Error>> wrong(survey.slaves.size());
    std::vector<Script<void>> scripts;
    for (std::size_t at = 0; at < survey.slaves.size(); ++at)
        if (!survey.slaves[at].found.error) scripts.push_back(ask_phys(port, survey.slaves[at], survey.subject(at), wrong[at]));
    co_await all(std::move(scripts), DatagramPort::slaves_at_once);
    std::vector<Error> found;
    for (auto& of_slave : wrong) found.insert(found.end(), of_slave.begin(), of_slave.end());
    co_return found;
}

}  // namespace taktwerk::ecat
