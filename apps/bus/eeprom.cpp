// taktwerk bus eeprom: what slaves say of themselves (SII), to look at, to keep and to change.

#include "apps/bus/eeprom.hpp"

namespace taktwerk::apps {

void add_bus_eeprom(CLI::App& bus, Action& action) {
    auto* eeprom = bus.add_subcommand("eeprom", "the EEPROM (SII) of slaves: show, keep, write, set the alias");
    eeprom->require_subcommand(1);
    add_eeprom_read(*eeprom, action);
    add_eeprom_show(*eeprom, action);
    add_eeprom_backup(*eeprom, action);
    add_eeprom_write(*eeprom, action);
    add_eeprom_alias(*eeprom, action);
    add_eeprom_make(*eeprom, action);
}

}  // namespace taktwerk::apps
