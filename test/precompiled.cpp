// SPDX-License-Identifier: BSD-3-Clause
// Is compiled with the headers that tests find read: see BOX_QUERY_PRECOMPILE.
int main() {}
