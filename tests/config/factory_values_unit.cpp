// What the manuals state of factory values, what they leave open, and when a written value counts. Literals are typed from the manuals.

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "axes/port/parameter_text.hpp"
#include "tests/config/loaded_drive.hpp"

namespace taktwerk::config {
namespace {

using axes::DriveParameter;
using axes::FactoryValue;
using axes::ParameterEffect;

const DriveParameter& row(const LoadedDrive& drive, const std::string& name) {
    static const DriveParameter none;
    const auto found = axes::find_parameter(*drive.profile, name);
    if (!found) ADD_FAILURE() << drive.profile->name << " has no " << name;
    return found ? **found : none;
}

void expect_unknown(const LoadedDrive& drive, std::initializer_list<const char*> names) {
    for (const auto* name : names) {
        const auto& p = row(drive, name);
        EXPECT_EQ(p.factory, FactoryValue::unknown) << drive.profile->name << " " << name;
        EXPECT_FALSE(p.is_stated_factory(p.value)) << name << ": what nobody knows is never as the factory left it";
    }
}

// 2.1: P0.22 "10000 from the factory" (4), P4.00 "-1" (1), P4.28 "the drive itself" (4.7), P4.43 "0x0003" (8). P0.03 = 8 is what the user sets.
TEST(FactoryValues, OfTheSvDa200FourAreStated) {
    const auto drive = config::drive("sv-da200");
    std::map<std::string, std::int64_t> stated;
    for (const auto& p : drive.profile->parameters)
        if (axes::is_setting(p) && p.factory == FactoryValue::stated) stated[axes::name_of(p)] = p.value;
    EXPECT_EQ(stated, (std::map<std::string, std::int64_t>{{"P0.22", 10000}, {"P4.00", -1}, {"P4.28", 0}, {"P4.43", 3}}));
    expect_unknown(drive, {"P0.03", "P0.37", "P2.00", "P4.07", "P4.08", "P4.09", "P4.25", "605Dh", "607Fh", "60E0h", "6091h:01"});
    EXPECT_EQ(row(drive, "P0.03").value, 8) << "the simulated one comes commissioned";
    for (const auto* name : {"P0.03", "P0.22", "P4.07", "P4.08", "P4.09"})
        EXPECT_EQ(row(drive, name).effect, ParameterEffect::after_restart) << name;
}

// 5.3.1, 5.3.2, 5.4.2 name these objects and print no value. 6.1: the stars count after saving and switching off and on.
TEST(FactoryValues, OfTheTsvmThoseOfItsObjectsAreUnknown) {
    const auto drive = config::drive("tsvm-d6");
    expect_unknown(drive, {"605Ah", "605Dh", "6072h", "6080h", "PA38"});
    EXPECT_TRUE(row(drive, "PA47").is_stated_factory(0));
    EXPECT_TRUE(row(drive, "PA69").is_stated_factory(50));
    for (const auto* name : {"PA81", "PA84", "PA51", "PA69", "PA70"})
        EXPECT_EQ(row(drive, name).effect, ParameterEffect::after_saving) << name;
    EXPECT_EQ(row(drive, "PA5").effect, ParameterEffect::at_once);
}

// Table 7-2 prints a value for each row that can be written; what stands outside of it is read off pictures of the maker's tool.
TEST(FactoryValues, OfTheSv33EAllOfTable72AreStated) {
    const auto drive = config::drive("sv33-e");
    for (const auto& p : drive.profile->parameters) {
        if (p.section != "7.2" || p.change == axes::ParameterChange::never) continue;
        EXPECT_EQ(p.factory, FactoryValue::stated) << axes::name_of(p);
    }
    EXPECT_TRUE(row(drive, "P05.10").is_stated_factory(3));
    EXPECT_TRUE(row(drive, "P04.02").is_stated_factory(0));
    EXPECT_TRUE(row(drive, "P01.05").is_stated_factory(1048576));
    EXPECT_TRUE(row(drive, "6084h").is_stated_factory(100));
    EXPECT_TRUE(row(drive, "607Ch").is_stated_factory(0));
    EXPECT_EQ(row(drive, "P13.49").factory, FactoryValue::assumed);
    EXPECT_EQ(row(drive, "6068h").factory, FactoryValue::assumed) << "printed as x16";
    expect_unknown(drive, {"P22.00", "P1A.05"});
    for (const auto* name : {"P01.05", "P04.02"}) EXPECT_EQ(row(drive, name).effect, ParameterEffect::after_restart) << name;
    EXPECT_EQ(row(drive, "6091h:01").effect, ParameterEffect::at_once) << "7.3";
}

// 4.3 and 4.4 have a column for it (缺省), empty for 605Ah, 605Dh and some of 2000h. 6: they count after saving and switching off and on.
TEST(FactoryValues, OfTheSe808xThoseOfTheColumnAreStated) {
    const auto drive = config::drive("se-808x");
    EXPECT_TRUE(row(drive, "2000h:01").is_stated_factory(10));
    EXPECT_TRUE(row(drive, "2000h:02").is_stated_factory(10000));
    EXPECT_TRUE(row(drive, "605Eh").is_stated_factory(0));
    EXPECT_EQ(row(drive, "605Ah").factory, FactoryValue::assumed);
    EXPECT_EQ(row(drive, "605Dh").factory, FactoryValue::assumed);
    expect_unknown(drive, {"2000h:05", "2000h:07", "2000h:0D", "2000h:10", "2000h:12", "6081h", "607Ch"});
    for (const auto* name : {"2000h:01", "2000h:02", "2000h:11"}) EXPECT_EQ(row(drive, name).effect, ParameterEffect::after_saving) << name;
    EXPECT_EQ(row(drive, "6085h").effect, ParameterEffect::at_once);
}

// 5.1.1 to 5.1.3; where 4.x prints another value the one of 5.1 is taken, and not called the manual's.
TEST(FactoryValues, OfTheXp200ThoseThatContradictThemselvesAreAssumed) {
    const auto drive = config::drive("xp200");
    EXPECT_TRUE(row(drive, "Pr136").is_stated_factory(0));
    EXPECT_TRUE(row(drive, "Pr000").is_stated_factory(315));
    for (const auto* name : {"Pr005", "Pr007", "Pr019", "Pr038", "Pr072"})
        EXPECT_EQ(row(drive, name).factory, FactoryValue::assumed) << name;
    expect_unknown(drive, {"Pr002", "Pr116", "Pr176"});
    EXPECT_EQ(row(drive, "Pr004").effect, ParameterEffect::after_restart);
}

}  // namespace
}  // namespace taktwerk::config
