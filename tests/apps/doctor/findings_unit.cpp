// Facts of invented computers, and what the doctor makes of them.
#include <gmock/gmock.h>

#include <algorithm>

#include "apps/doctor/findings.hpp"
#include "tests/apps/doctor/host_tree.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using test::HostTree;
using test::MemoryPorts;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

Wanted at_1ms(int cpu = 3) { return {1ms, 100us, cpu}; }

std::vector<Finding> of_host(const HostTree& host, const Wanted& wanted = at_1ms()) {
    return host_findings(host_facts(host.files(), wanted.cpu), wanted);
}

const Finding* find(const std::vector<Finding>& all, const std::string& code) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const Finding& f) { return f.code == code; });
    return found == all.end() ? nullptr : &*found;
}

std::vector<std::string> bad(const std::vector<Finding>& all) {
    std::vector<std::string> codes;
    for (const auto& f : all)
        if (f.severity != Severity::good) codes.push_back(f.code);
    return codes;
}

TEST(DoctorFiles, ListsOfCpusAsTheKernelWritesThem) {
    EXPECT_THAT(cpu_list("0,2-4"), ElementsAre(0, 2, 3, 4));
    EXPECT_THAT(cpu_list("7"), ElementsAre(7));
    for (const auto* nonsense : {"", "(null)", "4-2", "-1", "1,", "0-99999999", "1;2", "managed_irq,2"})
        EXPECT_THAT(cpu_list(nonsense), Not(Contains(2))) << nonsense;
}

TEST(DoctorFiles, WhatIsNotThereIsNothing) {
    HostTree host;
    EXPECT_FALSE(host.files().text("/proc/cmdline").has_value());
    EXPECT_FALSE(host.files().number("/proc/cmdline").has_value());
    EXPECT_THAT(host.files().names("/sys/class/net"), IsEmpty());
    EXPECT_EQ(host.files().link_name("/sys/class/net/eth0/device"), "");
    host.put("/proc/cmdline", "quiet\n");
    EXPECT_EQ(host.files().text("/proc/cmdline"), "quiet");
    EXPECT_FALSE(host.files().number("/proc/cmdline").has_value());
}

// A computer whose files say nothing gets no finding that accuses it of anything but what a user without rights lacks.
TEST(DoctorFindings, AnEmptyTreeDoesNotCrashAndAccusesNobody) {
    const auto found = bad(of_host(HostTree{}));
    EXPECT_THAT(found, Contains("kernel.not_preempt_rt"));
    for (const auto* code : {"kernel.virtual_machine", "clock.source", "cpu.governor", "cpu.smt", "memory.huge_pages", "memory.compaction",
                             "network.receive_buffer"})
        EXPECT_THAT(found, Not(Contains(code)));
}

TEST(DoctorFindings, AComputerAsDeliveredHasEachOfItsTroubles) {
    HostTree host;
    test::delivered(host);
    const auto all = of_host(host);
    EXPECT_THAT(bad(all), ::testing::UnorderedElementsAre("kernel.not_preempt_rt", "clock.source", "rights.priority", "rights.memory",
                                                          "cpu.sleep", "cpu.governor", "cpu.isolation", "cpu.smt", "cpu.irqbalance",
                                                          "memory.huge_pages", "memory.compaction", "network.receive_buffer"));
    for (const auto& f : all) {
        if (f.severity == Severity::good) continue;
        EXPECT_FALSE(f.found.empty()) << f.code;
        EXPECT_FALSE(f.costs.empty()) << f.code;
        EXPECT_FALSE(f.source.empty()) << f.code << ": a figure without a source";
        EXPECT_FALSE(f.remedy.empty()) << f.code;
        EXPECT_EQ(f.found.find('\n'), std::string::npos) << f.code;
    }
}

TEST(DoctorFindings, ASetUpComputerHasNone) {
    HostTree host;
    test::set_up(host);
    const auto all = of_host(host);
    EXPECT_THAT(bad(all), IsEmpty());
    EXPECT_THAT(all, Contains(Field(&Finding::code, "cpu.isolation")));  // it was looked at
}

// The kernel's own words for its sleep states and frequencies are the figures: 133 us; 3.2 GHz against 0.8: four times the computing time of 100 us.
TEST(DoctorFindings, FiguresAreThoseOfTheComputer) {
    HostTree host;
    test::delivered(host);
    const auto all = of_host(host);
    const auto* sleep = find(all, "cpu.sleep");
    ASSERT_NE(sleep, nullptr);
    EXPECT_EQ(sleep->cost_us, 133);
    EXPECT_THAT(sleep->found, HasSubstr("C6"));
    const auto* governor = find(all, "cpu.governor");
    ASSERT_NE(governor, nullptr);
    EXPECT_DOUBLE_EQ(governor->cost_us, 300);
    EXPECT_THAT(governor->found, HasSubstr("powersave"));
}

TEST(DoctorFindings, ASleepStateThatIsSwitchedOffCostsNothing) {
    HostTree host;
    test::delivered(host);
    host.put("/sys/devices/system/cpu/cpu3/cpuidle/state2/disable", "1\n");
    const auto all = of_host(host);
    const auto* sleep = find(all, "cpu.sleep");
    ASSERT_NE(sleep, nullptr);
    EXPECT_EQ(sleep->cost_us, 2);
}

// Kernels of 6.12 and later are PREEMPT_RT by themselves and lack /sys/kernel/realtime; older patched ones have it.
TEST(DoctorFindings, BothKindsOfPreemptRtAreKnown) {
    HostTree patched, own, none;
    patched.put("/sys/kernel/realtime", "1\n").put("/proc/sys/kernel/version", "#1 SMP PREEMPT RT\n");
    own.put("/proc/sys/kernel/version", "#1 SMP PREEMPT_RT Debian 6.12.6-1\n");
    none.put("/proc/sys/kernel/version", "#1 SMP PREEMPT_DYNAMIC\n").put("/sys/kernel/realtime", "0\n");
    EXPECT_TRUE(host_facts(patched.files(), {}).kernel.preempt_rt);
    EXPECT_TRUE(host_facts(own.files(), {}).kernel.preempt_rt);
    EXPECT_FALSE(host_facts(none.files(), {}).kernel.preempt_rt);
}

// What costs half the cycle is in the way, what costs a twentieth is to be mended; the same 1 ms is 10 % of 10 ms.
TEST(DoctorFindings, TheCycleDecidesHowBadAThingIs) {
    EXPECT_EQ(severity_of(500, 1ms), Severity::unfit);
    EXPECT_EQ(severity_of(499, 1ms), Severity::warning);
    EXPECT_EQ(severity_of(50, 1ms), Severity::warning);
    EXPECT_EQ(severity_of(49, 1ms), Severity::note);
    HostTree host;
    test::delivered(host);
    const auto short_cycle = of_host(host, {1ms, 100us, 3}), long_cycle = of_host(host, {10ms, 1ms, 3});
    EXPECT_EQ(find(short_cycle, "kernel.not_preempt_rt")->severity, Severity::unfit);
    EXPECT_EQ(find(long_cycle, "kernel.not_preempt_rt")->severity, Severity::warning);
}

TEST(DoctorFindings, TheDearestComesFirstAndWhatIsGoodLast) {
    HostTree host;
    test::delivered(host);
    auto all = of_host(host);
    sort_by_cost(all);
    ASSERT_GT(all.size(), 5u);
    EXPECT_EQ(all.front().code, "rights.memory");  // 10 ms: swap
    for (std::size_t i = 1; i < all.size(); ++i) {
        EXPECT_GE(static_cast<int>(all[i - 1].severity), static_cast<int>(all[i].severity));
        if (all[i - 1].severity == all[i].severity) {
            EXPECT_GE(all[i - 1].cost_us, all[i].cost_us);
        }
    }
    EXPECT_EQ(all.back().severity, Severity::good);
}

TEST(DoctorFindings, RightsOfRootAndLimitsOfAUserCountAlike) {
    HostTree host;
    test::delivered(host);
    host.put("/proc/self/limits",
             "Max locked memory         unlimited            unlimited            bytes     \n"
             "Max realtime priority     95                   95                   \n");
    const auto all = of_host(host);
    EXPECT_EQ(find(all, "rights.priority")->severity, Severity::good);
    EXPECT_EQ(find(all, "rights.memory")->severity, Severity::good);
}

TEST(DoctorFindings, AVirtualMachineIsNamed) {
    HostTree host;
    test::set_up(host);
    host.put("/proc/cpuinfo", "processor\t: 0\nflags\t\t: fpu hypervisor tsc\n").put("/sys/class/dmi/id/sys_vendor", "QEMU\n");
    const auto all = of_host(host);
    ASSERT_NE(find(all, "kernel.virtual_machine"), nullptr);
    EXPECT_THAT(find(all, "kernel.virtual_machine")->found, HasSubstr("QEMU"));
    HostTree real;
    test::set_up(real);
    EXPECT_EQ(find(of_host(real), "kernel.virtual_machine"), nullptr);
}

TEST(DoctorFindings, AShareOfRealTimeThatRunsOutIsTheRestOfTheSecond) {
    HostTree host;
    test::set_up(host);
    host.put("/proc/sys/kernel/sched_rt_runtime_us", "300000\n");
    const auto all = of_host(host);
    ASSERT_NE(find(all, "kernel.rt_share"), nullptr);
    EXPECT_EQ(find(all, "kernel.rt_share")->cost_us, 700'000);
    host.put("/proc/sys/kernel/sched_rt_runtime_us", "-1\n");
    EXPECT_THAT(bad(of_host(host)), ElementsAre("kernel.rt_unlimited"));
}

TEST(DoctorFindings, IsolationThatLacksTheTickIsCheaperThanNone) {
    HostTree host;
    test::set_up(host);
    host.put("/sys/devices/system/cpu/nohz_full", "(null)\n").put("/proc/cmdline", "isolcpus=3\n");
    const auto all = of_host(host);
    EXPECT_THAT(bad(all), ElementsAre("cpu.isolation"));
    EXPECT_EQ(find(all, "cpu.isolation")->cost_us, 10);
    EXPECT_THAT(find(all, "cpu.isolation")->remedy, AllOf(HasSubstr("nohz_full=3"), HasSubstr("cpus: [3]")));
}

// --- the port ---

std::vector<Finding> of_port(const HostTree& host, const MemoryPorts& ports = {}, const std::string& name = "eth1") {
    return port_findings(port_facts(host.files(), ports, name), at_1ms());
}

TEST(DoctorPort, AFreePortHasNoTrouble) {
    HostTree host;
    test::free_port(host);
    MemoryPorts ports;
    ports.settings["eth1"] = {.driver = "igb", .receive_us = 0, .send_us = 0, .adaptive_receive = false, .energy_efficient = false};
    const auto all = of_port(host, ports);
    EXPECT_THAT(bad(all), IsEmpty());
    EXPECT_NE(find(all, "port.alone"), nullptr);
}

TEST(DoctorPort, OneThatIsNotThereIsSaidAndNothingElse) {
    HostTree host;
    test::free_port(host);
    for (const auto* name : {"eth7", "../eth1", "", "eth1/", "a\"b"})
        EXPECT_THAT(bad(of_port(host, {}, name)), ElementsAre("port.missing")) << name;
    MemoryPorts ports;
    ports.sockets_have = {"eth0", "eth1"};
    EXPECT_THAT(bad(of_port(host, ports, "eth7")), ElementsAre("port.missing"));
    EXPECT_THAT(find(of_port(host, ports, "eth7"), "port.missing")->remedy, HasSubstr("eth0, eth1"));
}

// What sockets can have and what /sys shows are two things in a network namespace of one's own. Each way round is said as it is.
TEST(DoctorPort, WhatIsInAnotherNetworkNamespaceIsSaid) {
    HostTree host;
    test::free_port(host);
    MemoryPorts bare;
    bare.sockets_have.emplace();
    const auto there = of_port(host, bare);
    EXPECT_THAT(bad(there), ElementsAre("port.missing"));
    EXPECT_EQ(find(there, "port.alone"), nullptr) << "nothing of what /sys shows is praised";
    EXPECT_THAT(find(there, "port.missing")->found, AllOf(HasSubstr("another network namespace"), HasSubstr("the loopback alone")));
    EXPECT_THAT(find(there, "port.missing")->remedy,
                AllOf(HasSubstr("ip netns exec NAME taktwerk doctor --nic eth1"), HasSubstr("ip link set eth1 netns")));
    const auto gone = of_port(host, bare, "eth7");
    EXPECT_THAT(find(gone, "port.missing")->found, AllOf(HasSubstr("there is no network interface eth7"), HasSubstr("the loopback alone")));

    MemoryPorts inside;
    inside.sockets_have = {"v0"};
    const auto here = of_port(host, inside, "v0");
    EXPECT_THAT(bad(here), ElementsAre("port.unseen"));
    EXPECT_THAT(find(here, "port.unseen")->remedy, HasSubstr("ip netns exec"));
    EXPECT_EQ(find(here, "port.unseen")->severity, Severity::warning) << "it may be as good as any";
    EXPECT_THAT(bad(of_port(host, inside, "../v0")), ElementsAre("port.missing")) << "no name becomes one by that";
}

TEST(DoctorPort, SwitchedOffWithoutLinkAndAtASwitch) {
    HostTree host;
    test::free_port(host);
    host.put("/sys/class/net/eth1/speed", "1000\n");
    EXPECT_THAT(bad(of_port(host)), ElementsAre("port.link"));
    host.put("/sys/class/net/eth1/carrier", "0\n");
    EXPECT_THAT(bad(of_port(host)), ElementsAre("port.no_carrier"));
    host.put("/sys/class/net/eth1/flags", "0x1002\n");
    EXPECT_THAT(bad(of_port(host)), ElementsAre("port.down"));
}

TEST(DoctorPort, InterruptsThatWaitAndALinkThatSleepsAreChangedByEthtoolsWords) {
    HostTree host;
    test::free_port(host);
    MemoryPorts ports;
    ports.settings["eth1"] = {
        .driver = "igb", .receive_us = 60, .send_us = 0, .adaptive_receive = false, .energy_efficient = true, .energy_efficient_now = true};
    const auto all = of_port(host, ports);
    const auto* waits = find(all, "port.coalescing");
    ASSERT_NE(waits, nullptr);
    EXPECT_EQ(waits->cost_us, 60);
    EXPECT_EQ(waits->remedy, "ethtool -C eth1 rx-usecs 0");
    ASSERT_EQ(waits->changes.size(), 2u);  // now, and when the interface comes again
    EXPECT_EQ(waits->changes[0].kind, HostChange::Kind::ethernet);
    EXPECT_EQ(waits->changes[0].value, "0");
    EXPECT_EQ(waits->changes[1].target, "/etc/udev/rules.d/60-taktwerk-eth1-coalescing.rules");
    const auto* eee = find(all, "port.eee");
    ASSERT_NE(eee, nullptr);
    EXPECT_EQ(eee->cost_us, 30);  // IEEE 802.3, 78.5: 100BASE-TX
}

TEST(DoctorPort, WhoElseUsesItIsNamed) {
    HostTree host;
    test::free_port(host);
    host.put("/run/NetworkManager/devices/3", "[device]\nmanaged=true\n")
        .put("/run/systemd/netif/links/3", "ADMIN_STATE=configuring\n")
        .put("/proc/812/comm", "dhclient\n")
        .put("/proc/812/cmdline", std::string("dhclient\0-4\0eth1\0", 17))
        .put("/proc/net/route", "Iface\tDestination\neth1\t0000A8C0\n")
        .put("/proc/sys/net/ipv6/conf/eth1/disable_ipv6", "0\n")
        .put("/proc/net/packet", "sk RefCnt Type Proto Iface R Rmem User Inode\nffff 3 3 88a4 3 1 0 0 999\n")
        .link("/sys/class/net/eth1/master", "../br0");
    const auto all = of_port(host);
    EXPECT_THAT(bad(all), ::testing::UnorderedElementsAre("port.managed", "port.managed", "port.managed", "port.addressed", "port.ipv6",
                                                          "port.other_master", "port.bridged"));
    EXPECT_EQ(find(all, "port.bridged")->severity, Severity::unfit);
    EXPECT_EQ(find(all, "port.other_master")->severity, Severity::unfit);
    EXPECT_EQ(find(all, "port.alone"), nullptr);
}

// The same files about another interface say nothing of this one.
TEST(DoctorPort, WhatOthersDoOnOtherInterfacesIsTheirs) {
    HostTree host;
    test::free_port(host);
    host.put("/run/NetworkManager/devices/2", "[device]\nmanaged=true\n")
        .put("/run/NetworkManager/devices/3", "[device]\nmanaged=false\n")
        .put("/run/systemd/netif/links/3", "ADMIN_STATE=unmanaged\n")
        .put("/proc/812/comm", "dhclient\n")
        .put("/proc/812/cmdline", std::string("dhclient\0eth0\0", 14))
        .put("/proc/net/packet", "sk RefCnt Type Proto Iface R Rmem User Inode\nffff 3 3 88a4 2 1 0 0 999\nffff 3 3 0003 3 1 0 0 998\n");
    EXPECT_THAT(bad(of_port(host)), IsEmpty());
}

TEST(DoctorPort, InterruptsOnAnotherCpuAreFoundByTheirNames) {
    HostTree host;
    test::free_port(host);
    host.put("/sys/class/net/eth1/device/msi_irqs/124", "msix\n")
        .put("/sys/class/net/eth1/device/msi_irqs/125", "msix\n")
        .put("/proc/irq/124/eth1-TxRx-0/x", "")
        .put("/proc/irq/124/smp_affinity_list", "0-1\n")
        .put("/proc/irq/125/other/x", "")
        .put("/proc/irq/125/smp_affinity_list", "2\n");
    const auto all = of_port(host);
    const auto* where = find(all, "port.interrupts");
    ASSERT_NE(where, nullptr);
    EXPECT_THAT(where->found, AllOf(HasSubstr("124"), Not(HasSubstr("125")), HasSubstr("0, 1")));
    EXPECT_EQ(where->remedy, "echo 3 > /proc/irq/124/smp_affinity_list");
    host.put("/proc/irq/124/smp_affinity_list", "3\n");
    EXPECT_EQ(find(of_port(host), "port.interrupts"), nullptr);
}

}  // namespace
}  // namespace taktwerk::apps
