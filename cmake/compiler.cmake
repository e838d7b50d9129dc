# Flags that hold for every target. Results are repeatable bit for bit: no contraction, no fast-math.
add_compile_options(-Wall -Wextra -Wconversion -Wshadow -Wnon-virtual-dtor -ffp-contract=off)
if(BODEFLOW_WERROR)
  add_compile_options(-Werror)
endif()
if(BODEFLOW_SANITIZE)
  add_compile_options(-fsanitize=${BODEFLOW_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${BODEFLOW_SANITIZE})
endif()
