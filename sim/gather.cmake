# Second half of raygate_model's build step: gathers what Verilator wrote into DIR for class NAME.
# Writes all.cpp, one translation unit; slow.cpp, another one of what runs once in a model's life, where that is
# much; and all.d, on what both depend, in make's syntax.
file(GLOB sources RELATIVE ${DIR} ${DIR}/*.cpp)
list(REMOVE_ITEM sources all.cpp slow.cpp)  # there if two builds meet in one folder
set(slow ${sources})
list(FILTER slow INCLUDE REGEX "__Slow\\.cpp")
set(slow_bytes 0)
foreach(file ${slow})
  file(SIZE ${DIR}/${file} bytes)
  math(EXPR slow_bytes "${slow_bytes} + ${bytes}")
endforeach()
if(slow_bytes LESS 200000)  # it would take longer to read Verilator's headers again
  set(slow)
endif()
list(REMOVE_ITEM sources "" ${slow})
foreach(part sources slow)
  list(TRANSFORM ${part} REPLACE "(.+)" "#include \"\\1\"")
  list(JOIN ${part} "\n" ${part})
endforeach()
file(WRITE ${DIR}/all.cpp "${sources}\n")
file(WRITE ${DIR}/slow.cpp "${slow}\n")

# Verilator names every file it wrote as a target; the build knows of all.cpp alone. What it read has names relative to
# the folder that it and this script run in.
file(READ ${DIR}/${NAME}__ver.d depends)
string(REGEX REPLACE "^[^:]*:" "" depends "${depends}")
string(REGEX REPLACE " ([^/ \n])" " ${CMAKE_CURRENT_SOURCE_DIR}/\\1" depends "${depends}")
string(PREPEND depends "${DIR}/all.cpp:")
file(WRITE ${DIR}/all.d "${depends}")
