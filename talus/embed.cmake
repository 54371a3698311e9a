# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Writes the table of public examples into a source: cmake -DTABLE=... -DOUTPUT=... -P embed.cmake
file(READ ${TABLE} _text)
file(WRITE ${OUTPUT}
  "#include \"talus/commands.hpp\"\n\n"
  "std::string_view talus::command::public_data_table() {\n  return R\"talus-table(${_text})talus-table\";\n}\n")
