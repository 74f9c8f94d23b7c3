# Second half of raygate_model's build step: gathers what Verilator wrote into DIR for class NAME.
# Writes all.cpp, one translation unit, and all.d, on what it depends, in make's syntax.
file(GLOB sources RELATIVE ${DIR} ${DIR}/*.cpp)
list(REMOVE_ITEM sources all.cpp)  # there if two builds meet in one folder
list(TRANSFORM sources REPLACE "(.+)" "#include \"\\1\"")
list(JOIN sources "\n" text)
file(WRITE ${DIR}/all.cpp "${text}\n")

# Verilator names every file it wrote as a target; the build knows of all.cpp alone.
file(READ ${DIR}/${NAME}__ver.d depends)
string(REGEX REPLACE "^[^:]*:" "${DIR}/all.cpp:" depends "${depends}")
file(WRITE ${DIR}/all.d "${depends}")
