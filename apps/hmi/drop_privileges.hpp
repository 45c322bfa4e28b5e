#pragma once
// A server of pages needs nothing that a user of this host does not have.

namespace taktwerk::apps {

/// Gives up the capabilities that the command's file brought (a bus needs them, a page does not); no process of this one gets any again. Root stays root:
/// the socket of a machine may be somebody else's.
void drop_privileges();

}  // namespace taktwerk::apps
