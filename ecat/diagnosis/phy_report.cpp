#include "ecat/diagnosis/phy_report.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration phy_poll = std::chrono::microseconds{100};
constexpr Duration phy_patience = std::chrono::milliseconds{50};  ///< a command takes some 30 us
constexpr std::uint8_t for_application = 1u << 0, take_away = 1u << 1;

struct PhyWord {
    std::uint16_t value = 0;
    bool silent = false;  ///< no PHY answered
};

/// One register of one PHY.
Script<Result<PhyWord>> read_phy_word(DatagramPort& port, std::uint16_t station, std::uint8_t address, std::uint8_t number,
                                      std::string subject) {
    std::vector<std::byte> where(2);
    where[0] = static_cast<std::byte>(address);
    where[1] = static_cast<std::byte>(number);
    const Reply placed = co_await port.fpwr(station, reg::mii_phy_address, where);
    if (!placed.ok()) co_return unanswered(subject, "MII management (0512h)", placed);
    const Reply asked = co_await port.fpwr(station, reg::mii_control, mii::read);
    if (!asked.ok()) co_return unanswered(subject, "MII management (0510h)", asked);
    const Instant started = co_await time();
    for (;;) {
        const Reply reply = co_await port.fprd(station, reg::mii_control, 6);
        if (!reply.ok()) co_return unanswered(subject, "MII management (0510h)", reply);
        const std::uint16_t control = reply.u16();
        if ((control & mii::busy) == 0) {
            PhyWord word;
            word.silent = (control & (mii::read_error | mii::command_error)) != 0;
            word.value = reply.u16(4);
            co_return word;
        }
        const Instant now = co_await time();
        if (now - started >= phy_patience)
            co_return Error{"phy.busy", subject, fmt::format("its MII management stays busy (0510h = {:04X}h)", control),
                            "power-cycle the slave"};
        co_await pause(phy_poll);
    }
}

Script<Result<std::optional<PhyRegisters>>> read_phy(DatagramPort& port, std::uint16_t station, std::uint8_t address, std::string subject) {
    PhyRegisters phy;
    // The link bit keeps that the link was lost until it is read: the second reading is the present.
    const std::array<std::pair<std::uint8_t, std::uint16_t*>, 8> words{{{phy_reg::status, &phy.status},
                                                                        {phy_reg::status, &phy.status},
                                                                        {phy_reg::control, &phy.control},
                                                                        {phy_reg::id1, &phy.id1},
                                                                        {phy_reg::id2, &phy.id2},
                                                                        {phy_reg::advertised, &phy.advertised},
                                                                        {phy_reg::partner, &phy.partner},
                                                                        {phy_reg::expansion, &phy.expansion}}};
    for (const auto& [number, place] : words) {
        const Result<PhyWord> word = co_await read_phy_word(port, station, address, number, subject);
        if (!word) co_return word.error();
        if (word->silent) co_return std::optional<PhyRegisters>{};
        *place = word->value;
    }
    if (phy_maker_code(phy) == 0 && phy.status == 0xFFFF) co_return std::optional<PhyRegisters>{};
    co_return std::optional<PhyRegisters>{phy};
}

/// The application may have it; then it is asked for.
Script<Result<void>> take_mii(DatagramPort& port, std::uint16_t station, std::string subject) {
    const Reply owner = co_await port.fprd(station, reg::mii_pdi_access, 1);
    if (!owner.ok()) co_return unanswered(subject, "MII management (0517h)", owner);
    if ((owner.data[0] & std::byte{for_application}) == std::byte{0}) co_return Result<void>{};
    const Reply taken = co_await port.fpwr(station, reg::mii_pdi_access, take_away);
    if (!taken.ok()) co_return unanswered(subject, "MII management (0517h)", taken);
    const Reply now = co_await port.fprd(station, reg::mii_pdi_access, 1);
    if (!now.ok()) co_return unanswered(subject, "MII management (0517h)", now);
    if ((now.data[0] & std::byte{for_application}) == std::byte{0}) co_return Result<void>{};
    co_return Error{"phy.taken", subject, "its own processor keeps the MII management (0517h = 01h)",
                    "try again while the slave is in INIT"};
}

}  // namespace

Script<Result<std::vector<PhyReport>>> read_phys(DatagramPort& port, const SurveyedSlave& slave, std::optional<unsigned> only,
                                                 std::string subject) {
    const std::uint16_t station = slave.found.station;
    const Result<void> taken = co_await take_mii(port, station, subject);
    if (!taken) co_return taken.error();
    const Reply control = co_await port.fprd(station, reg::mii_control, 2);
    if (!control.ok()) co_return unanswered(subject, "MII management (0510h)", control);
    const std::uint8_t offset = mii::address_offset(control.u16());
    std::vector<PhyReport> reports;
    for (unsigned p = 0; p < ports_per_slave; ++p) {
        if ((only && *only != p) || slave.ports[p].kind != PortKind::mii) continue;
        PhyReport report;
        report.port = p;
        // Some controllers add the offset themselves: then the first address is nobody's.
        for (unsigned attempt = 0; attempt < 2; ++attempt) {
            report.address = static_cast<std::uint8_t>(attempt == 0 ? offset + p : p);
            Result<std::optional<PhyRegisters>> phy = co_await read_phy(port, station, report.address, subject);
            if (!phy && phy.error().code != "phy.busy") co_return phy.error();
            if (!phy) report.trouble = phy.error();
            else report.phy = *phy;
            if (report.phy || report.trouble || offset == 0) break;
        }
        if (!report.phy && !report.trouble)
            report.trouble = Error{"phy.silent", fmt::format("{} port {}", subject, p), "no PHY answers to the controller",
                                   "some slaves do not connect the management wires; the lights at the socket tell of the link"};
        reports.push_back(std::move(report));
    }
    co_return reports;
}

std::optional<Error> phy_trouble(const PhyReport& report, const std::string& subject) {
    const PhyLink link = report.link();
    if (!report.phy || !link.up || (link.megabits == 100 && link.full_duplex)) return std::nullopt;
    if (link.megabits == 0)
        return Error{
            "bus.wrong_link", subject,
            fmt::format("port {}: a link, but the two ends have not agreed on anything: EtherCAT needs 100 Mbit full duplex at both",
                        report.port),
            "look what is plugged in at its other end, and at the cable"};
    std::string remedy;
    if (link.negotiates && !link.agreed) remedy = "the other end does not negotiate: switch its auto-negotiation on";
    else if (!link.negotiates) remedy = "auto-negotiation is off at this PHY: that is how the slave was built or strapped";
    else remedy = "the other end offers no more: what is plugged in there is no EtherCAT device, or a cable has two pairs broken";
    return Error{"bus.wrong_link", subject,
                 fmt::format("port {}: {} Mbit {} duplex, and EtherCAT needs 100 Mbit full duplex: frames are lost", report.port,
                             link.megabits, link.full_duplex ? "full" : "half"),
                 std::move(remedy)};
}

std::string phy_finding(const PhyReport& report) {
    const auto trouble = phy_trouble(report, {});
    if (!trouble) return {};
    return report.link().megabits == 0 ? trouble->what : trouble->what + "; " + trouble->remedy;
}

}  // namespace taktwerk::ecat
