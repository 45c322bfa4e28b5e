// What a slave says about its dictionary, asked through frames of a simulated slave.
#include "ecat/coe/object_info.hpp"

#include <gmock/gmock.h>

#include <fmt/format.h>

#include <set>

#include "tests/ecat/coe/coe_bench.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

DeviceDescription talkative() {
    auto description = sim::small_drive();
    description.mailbox->sdo_info = true;
    for (auto& object : description.objects)
        if (object.index == 0x6098) object.name = "homing method";
    return description;
}

ObjectEntry entry(std::uint16_t index, std::uint8_t sub, std::string name, DataType type = DataType::I32) {
    ObjectEntry object;
    object.index = index, object.sub = sub, object.name = std::move(name), object.type = type;
    return object;
}

TEST(ObjectInfo, ListsWhatTheSlaveHas) {
    CoeBench bench{talkative()};

    const auto all = bench.run(list_objects(*bench.port, bench.mailbox, ObjectList::all));
    const auto rx = bench.run(list_objects(*bench.port, bench.mailbox, ObjectList::rx_mappable));
    const auto tx = bench.run(list_objects(*bench.port, bench.mailbox, ObjectList::tx_mappable));

    // Its own eleven, 1008h and 1018h, two mappings 16xxh/17xxh and one 1A00h, 1C00h, 1C12h, 1C13h, 1C32h, 1C33h.
    ASSERT_TRUE(all) << all.error().text();
    EXPECT_THAT(*all, ElementsAre(0x1000, 0x1008, 0x1018, 0x1600, 0x1701, 0x1A00, 0x1C00, 0x1C12, 0x1C13, 0x1C32, 0x1C33, 0x2000, 0x2001,
                                  0x6040, 0x6041, 0x6060, 0x6064, 0x607A, 0x6081, 0x6098, 0x60F0));
    EXPECT_THAT(*rx, ElementsAre(0x6040, 0x6060, 0x607A));
    EXPECT_THAT(*tx, ElementsAre(0x6041, 0x6064));
}

// A mailbox of 128 bytes: 122 - 6 = 116 bytes a fragment. 579 indexes and the list type are 1160 bytes: ten fragments.
TEST(ObjectInfo, AListLongerThanTheMailboxComesInFragments) {
    auto description = talkative();
    std::set<std::uint16_t> wanted;
    CoeBench small{description};
    const auto own = small.run(list_objects(*small.port, small.mailbox, ObjectList::all)).value();
    wanted.insert(own.begin(), own.end());
    for (std::uint16_t index = 0x3000; wanted.size() < 579; ++index) {
        description.objects.push_back(entry(index, 0, "parameter"));
        wanted.insert(index);
    }
    CoeBench bench{description};
    const auto counter_before = bench.mailbox.received;

    const auto all = bench.run(list_objects(*bench.port, bench.mailbox, ObjectList::all));

    ASSERT_TRUE(all) << all.error().text();
    EXPECT_EQ((std::vector<std::uint16_t>(wanted.begin(), wanted.end())), *all);
    EXPECT_EQ((bench.mailbox.received + 7 - counter_before) % 7, 10 % 7) << "ten messages";
}

// 579 objects, each described, and each of their entries: what `sdo dump` asks.
TEST(ObjectInfo, ADictionaryOf579ObjectsIsDescribedCompletely) {
    auto description = talkative();
    for (std::uint16_t n = 0; n < 558; ++n)
        description.objects.push_back(entry(static_cast<std::uint16_t>(0x3000 + n), 0, fmt::format("parameter {}", n)));
    CoeBench bench{description};

    const auto all = bench.run(list_objects(*bench.port, bench.mailbox, ObjectList::all));
    ASSERT_TRUE(all) << all.error().text();
    ASSERT_THAT(*all, SizeIs(579));
    for (const auto index : *all) {
        const auto object = bench.run(describe_object(*bench.port, bench.mailbox, index));
        ASSERT_TRUE(object) << object.error().text();
        EXPECT_EQ(object->index, index);
        const bool parameter = index >= 0x3000 && index < 0x4000;
        EXPECT_EQ(object->name, parameter ? fmt::format("parameter {}", index - 0x3000) : object->name);
    }
}

TEST(ObjectInfo, DescribesVariablesArraysAndRecords) {
    auto description = talkative();
    description.objects.push_back(entry(0x607D, 1, "software limit negative"));
    description.objects.push_back(entry(0x607D, 2, "software limit positive"));
    CoeBench bench{description};
    const auto object = [&](std::uint16_t index) { return bench.run(describe_object(*bench.port, bench.mailbox, index)).value(); };

    const auto variable = object(0x6098);
    EXPECT_EQ(variable.code, ObjectCode::variable);
    EXPECT_EQ(variable.data_type, 0x0002) << "INTEGER8";
    EXPECT_EQ(variable.max_sub, 0);
    EXPECT_EQ(variable.name, "homing method");

    const auto array = object(0x607D);
    EXPECT_EQ(array.code, ObjectCode::array);
    EXPECT_EQ(array.data_type, 0x0004) << "INTEGER32";
    EXPECT_EQ(array.max_sub, 2);
    EXPECT_EQ(array.name, "software limit");

    const auto identity = object(0x1018);
    EXPECT_EQ(identity.code, ObjectCode::record);
    EXPECT_EQ(identity.data_type, 0x0023) << "IDENTITY, ETG.1000.6 table 54";
    EXPECT_EQ(identity.max_sub, 4);
}

TEST(ObjectInfo, DescribesEntriesWithTypeLengthAndAccess) {
    CoeBench bench{talkative()};
    const auto entry = [&](std::uint16_t index, std::uint8_t sub) {
        return bench.run(describe_entry(*bench.port, bench.mailbox, index, sub)).value();
    };

    const auto target = entry(0x607A, 0);
    EXPECT_EQ(target.data_type, 0x0004);
    EXPECT_EQ(target.bits, 32);
    EXPECT_EQ(target.access, 0x007F) << "read and write in PREOP, SAFEOP, OP; RxPDO";
    EXPECT_EQ(entry(0x6041, 0).access, 0x0087) << "read in all states; TxPDO";
    EXPECT_EQ(entry(0x2000, 1).access, 0x0038) << "write only";
    EXPECT_EQ(entry(0x1C12, 1).access, 0x000F) << "an assignment is written in PREOP";
    EXPECT_EQ(entry(0x1008, 0).bits, 88) << "11 characters";
    EXPECT_EQ(entry(0x1018, 2).name, "product code");
}

TEST(ObjectInfo, WhatDoesNotExistIsNamed) {
    CoeBench bench{talkative()};

    const auto object = bench.run(describe_object(*bench.port, bench.mailbox, 0x5000));
    const auto missing = bench.run(describe_entry(*bench.port, bench.mailbox, 0x1018, 9));

    ASSERT_FALSE(object);
    EXPECT_EQ(abort_code(object.error()), 0x06020000u);
    ASSERT_FALSE(missing);
    EXPECT_EQ(abort_code(missing.error()), 0x06090011u);
    EXPECT_THAT(missing.error().text(), HasSubstr("1018h:09"));
}

TEST(ObjectInfo, ASlaveWithoutTheServiceSaysSo) {
    CoeBench bench{sim::small_drive()};

    const auto list = bench.run(list_objects(*bench.port, bench.mailbox, ObjectList::all));

    ASSERT_FALSE(list);
    EXPECT_EQ(list.error().code, "sdo.no_info");
    EXPECT_THAT(list.error().text(), HasSubstr("slave 0 'x'"));
}

TEST(ObjectInfo, AnEmergencyBetweenFragmentsIsKeptAndTheListCompletes) {
    auto description = talkative();
    for (std::uint16_t n = 0; n < 200; ++n) description.objects.push_back(entry(static_cast<std::uint16_t>(0x3000 + n), 0, "parameter"));
    CoeBench bench{description};
    std::optional<Result<std::vector<std::uint16_t>>> list;
    bool raised = false;
    Runner runner{keep(list_objects(*bench.port, bench.mailbox, ObjectList::all), list)};

    for (int i = 0; i < 1000 && !runner.done(); ++i) {
        bench.step();
        if (!raised && bench.mailbox.received == 2) {  // two fragments of four are read
            bench.model->raise({0x3220, 0x04, {}});
            raised = true;
        }
        runner.step(bench.now);
        bench.pack();
    }

    ASSERT_TRUE(list && *list);
    EXPECT_THAT(**list, SizeIs(221));
    ASSERT_THAT(bench.log.entries(), SizeIs(1));
    EXPECT_EQ(bench.log.entries()[0].emergency.code, 0x3220);
    EXPECT_EQ(bench.log.entries()[0].slave, 5u);
    EXPECT_EQ(bench.mailbox.emergency.load(), 0x0004'3220u);
}

}  // namespace
}  // namespace taktwerk::ecat::test
