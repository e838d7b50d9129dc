function export_iddata(data, file)
%EXPORT_IDDATA  Writes an iddata object to a .mat file (u, y, Ts, names), or an idfrd object to a .csv file (f, re, im of each
%response): what the blocks acquisition.file and acquisition.frequency_response of bodeflow read.
if isa(data, 'idfrd')
  data = chgFreqUnit(data, 'Hz'); header = 'f [Hz]'; table = data.Frequency(:);
  for i = 1:size(data.ResponseData, 1), for j = 1:size(data.ResponseData, 2)
    g = squeeze(data.ResponseData(i, j, :)); header = sprintf('%s,re(G%d%d),im(G%d%d)', header, i, j, i, j); table = [table real(g) imag(g)]; %#ok<AGROW>
  end, end
  id = fopen(file, 'w'); fprintf(id, '%s\n', header); fprintf(id, [repmat('%.17g,', 1, size(table, 2) - 1) '%.17g\n'], table.'); fclose(id);
else
  u = data.InputData; y = data.OutputData; Ts = data.Ts; names = char([data.InputName; data.OutputName]); %#ok<NASGU>
  save(file, 'u', 'y', 'Ts', 'names', '-v7');
end
end
