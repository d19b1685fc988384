-- Opens a specification with a mistake in Neovim, connects the server, and prints what arrives.
local folder, file = vim.env.TUMATO_EDITORS, vim.env.TUMATO_FILE
vim.cmd("set runtimepath+=" .. folder .. "/vim")
vim.cmd("runtime! ftdetect/*.vim | filetype plugin on | syntax on")
vim.cmd("edit " .. file)
local function say(...) io.stdout:write(table.concat({ ... }, " ") .. "\n") end
say("filetype", vim.bo.filetype)
say("colour", vim.fn.synIDattr(vim.fn.synID(1, 1, 1), "name"))
local id = vim.lsp.start_client({ name = "tumato", cmd = { "tumato-sym", "lsp" }, root_dir = vim.fn.getcwd() })
vim.lsp.buf_attach_client(0, id)
local function errors()
  return vim.diagnostic.get(0, { severity = vim.diagnostic.severity.ERROR })
end
vim.wait(20000, function() return #errors() > 0 end, 20)
for _, each in ipairs(errors()) do say("error", each.lnum + 1, each.code, (each.message:gsub("\n", " "))) end
vim.api.nvim_buf_set_lines(0, 4, 5, false, { "rule: S_Door is open" })
vim.wait(20000, function() return #errors() == 0 end, 20)
say("errors left", #errors())
vim.lsp.stop_client(id)
vim.cmd("qa!")
