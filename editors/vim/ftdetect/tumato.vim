autocmd BufRead,BufNewFile *.tum,*.tmt setfiletype tumato
