// The command line tool.
// SPDX-License-Identifier: MIT
int main() { return 0; }
