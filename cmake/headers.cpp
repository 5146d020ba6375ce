// SPDX-License-Identifier: Apache-2.0
// Nothing but a source for the precompiled headers that the modules share.
