// Who stands on the cable is not who stands in the file.

#include <algorithm>

#include "ecat/wire/sii.hpp"
#include "tests/troubles/bench.hpp"

namespace taktwerk::troubles {

namespace {

using namespace ecat;

void by_alias(Bench& bench, char name, std::uint16_t alias) {
    bench.file(name).position.reset();
    bench.file(name).alias = alias;
}

void put_aliases(Bench& bench, std::uint16_t first, std::uint16_t second) {
    by_alias(bench, 'a', 7);
    by_alias(bench, 'b', 8);
    sim::SlaveOptions options;
    options.alias = first;
    bench.plug_in('s', options);
    options.alias = second;
    bench.plug_in('s', options);
}

void device_id_6_not_5(Bench& bench) {
    bench.file('b').position.reset();
    bench.file('b').device_id = 5;
    sim::SlaveOptions options;
    options.device_id = 6;
    bench.plug_in('s', options);
}

/// The EEPROM was written and the slave not switched off since: its register still holds what it was.
void alias_not_loaded(Bench& bench) {
    put_aliases(bench, 7, 0);
    bench.there('b').controller().eeprom().image()[std::size_t{2} * sii_word::alias] = std::byte{8};
}

void blank_eeprom(Bench& bench) {
    auto& image = bench.there('b').controller().eeprom().image();
    std::fill(image.begin(), image.end(), std::byte{0xFF});
}

}  // namespace

Chapter wrong_slaves() {
    return {"Another slave than the file says",
            "What `taktwerk bus scan --machine FILE` compares, the bring-up does, too: it touches no slave that is not the one it is taken "
            "for.",
            {{.name = "Two slaves exchanged",
              .staged = "servo and terminal in each other's place",
              .configured = "st",
              .there = "ts",
              .id = "bus.wrong_identity",
              .place = "slave 0 'a'",
              .cause = "expected vendor 000007FBh product 000C0108h, found vendor 00000ABCh",
              .remedy = "slaves 'a' and 'b' look swapped",
              .named = "ab"},
             {.name = "Slaves in another order",
              .staged = "the third stands first",
              .configured = "stm",
              .there = "mst",
              .id = "bus.wrong_identity",
              .place = "slave 0 'a'",
              .cause = "found vendor 00000DEFh",
              .remedy = "all slaves are there, in another order: the cable fits 'a' at 1, 'b' at 2, 'c' at 0",
              .named = "abc"},
             {.name = "Another product",
              .staged = "a servo of the same vendor with another product code",
              .configured = "sst",
              .there = "spt",
              .id = "bus.wrong_identity",
              .place = "slave 1 'b'",
              .cause = "found vendor 000007FBh product 000C0109h",
              .remedy = "set the device of this slave in the configuration",
              .named = "b"},
             {.name = "Another vendor",
              .staged = "a servo with the same product code of another vendor",
              .configured = "sst",
              .there = "svt",
              .id = "bus.wrong_identity",
              .place = "slave 1 'b'",
              .cause = "found vendor 00000666h product 000C0108h",
              .remedy = "set the device of this slave in the configuration",
              .named = "b"},
             {.name = "Another revision",
              .staged = "the file wants the revision exactly, and an older one is there",
              .configured = "sst",
              .there = "srt",
              .before = [](Bench& bench) { bench.file('b').revision_rule = RevisionRule::exact; },
              .id = "bus.wrong_identity",
              .place = "slave 1 'b'",
              .cause = "the right device in another revision: expected vendor 000007FBh product 000C0108h revision 00010001h",
              .remedy = "check its firmware, or set `revision_rule: any`",
              .named = "b"},
             {.name = "Wrong alias",
              .staged = "alias 9 where the file says 8",
              .configured = "ss",
              .there = " ",
              .before = [](Bench& bench) { put_aliases(bench, 7, 9); },
              .id = "bus.missing_slave",
              .place = "slave 'b'",
              .cause = "there is no slave at alias 8",
              .remedy = "set the alias in the drive and power-cycle it",
              .named = "b"},
             {.name = "The same alias twice",
              .staged = "both servos hold alias 7",
              .configured = "ss",
              .there = " ",
              .before = [](Bench& bench) { put_aliases(bench, 7, 7); },
              .id = "bus.duplicate_alias",
              .place = "slave 0 'a'",
              .cause = "alias 7 is set in two slaves, at positions 0 and 1",
              .remedy = "give one of them another one and power-cycle it",
              .named = "a"},
             {.name = "Alias written but not loaded",
              .staged = "alias 8 in the EEPROM, and the slave was not switched off since",
              .configured = "ss",
              .there = " ",
              .before = alias_not_loaded,
              .id = "bus.missing_slave",
              .place = "slave 'b'",
              .cause = "the EEPROM of slave 1 holds this alias, it was not loaded yet",
              .remedy = "power-cycle it",
              .named = "b"},
             {.name = "Wrong device id",
              .staged = "6 on its switches where the file says 5",
              .configured = "ss",
              .there = "s",
              .before = device_id_6_not_5,
              .id = "bus.missing_slave",
              .place = "slave 'b'",
              .cause = "there is no slave at device id 5",
              .remedy = "set the id on its switches",
              .named = "b"},
             {.name = "Last slave missing",
              .staged = "the cable ends before it",
              .there = "st",
              .id = "bus.missing_slave",
              .place = "slave 'c'",
              .cause = "the bus has 2 of 3 configured slaves",
              .remedy = "check power and cable behind slave 1",
              .named = "bc"},
             {.name = "A slave left out in the middle",
              .staged = "the cable goes past it to the one behind",
              .configured = "stm",
              .there = "sm",
              .id = "bus.missing_slave",
              .place = "slave 'b'",
              .cause = "the bus has 2 of 3 configured slaves, and those behind are there",
              .remedy = "put it between slave 0 and slave 1",
              .named = "ab"},
             {.name = "A slave without power before the start",
              .staged = "the one in the middle is switched off: the line ends before it",
              .before = [](Bench& bench) { bench.network.set_power(bench.there('b'), false); },
              .id = "bus.missing_slave",
              .place = "slave 'b'",
              .cause = "the bus has 1 of 3 configured slaves",
              .remedy = "check power and cable behind slave 0",
              .named = "ab"},
             {.name = "A slave too many at the end",
              .staged = "one that the file does not know",
              .there = "stst",
              .id = "bus.unexpected_slave",
              .place = "slave 3",
              .cause = "is on the bus but not in the configuration",
              .remedy = "unplug it",
              .named = "d"},
             {.name = "A slave too many in the middle",
              .staged = "one that the file does not know, between two that it does",
              .configured = "stm",
              .there = "sptm",
              .id = "bus.unexpected_slave",
              .place = "slave 1",
              .cause = "those behind it are the configured ones, one place further",
              .remedy = "unplug it",
              .named = "b"},
             {.name = "Empty EEPROM",
              .staged = "every byte of it is FFh",
              .before = blank_eeprom,
              .id = "bus.wrong_identity",
              .place = "slave 1 'b'",
              .cause = "its EEPROM is empty",
              .remedy = "write the vendor's EEPROM image",
              .named = "b"},
             {.name = "EEPROM that never answers",
              .staged = "its interface stays busy",
              .before = [](Bench& bench) { bench.there('b').controller().eeprom().faults().stays_busy = true; },
              .id = "bus.sii",
              .place = "slave 1 'b'",
              .cause = "the EEPROM stays busy",
              .remedy = "power-cycle the slave",
              .named = "b"},
             {.name = "EEPROM in the hands of its processor",
              .staged = "the slave's own processor takes it again at once",
              .before = [](Bench& bench) { bench.there('b').controller().eeprom().faults().held_by_application = true; },
              .id = "bus.sii_taken",
              .place = "slave 1 'b'",
              .cause = "its EEPROM is in the hands of its own processor",
              .remedy = "power-cycle",
              .named = "b"}}};
}

}  // namespace taktwerk::troubles
